# SPDX-License-Identifier: BSD-3-Clause
"""A function has at most 60 lines between its braces, or below its `def`; a file of code at most 700.

C++ is read as clang-format leaves it: the braces of a function's body stand alone on lines of one indentation.
"""
import ast
import re

import project

FUNCTION_LINES = 60
FILE_LINES = 700
TOPS = ("bench", "examples", "include", "lab", "python", "scripts", "src", "test")
CPP = (".cpp", ".hpp", ".c")
SHEBANG = re.compile(r"#!.*\b(bash|sh|python3)$")
NO_FUNCTION = re.compile(r"(template\s*<.*>\s*)?(inline\s+)?(namespace|class|struct|union|enum|extern)\b"
                         r"(?!.*\)( const| noexcept)*$)")
ENDS_ANOTHER = re.compile(r"([;{}]|//.*|\*/|public:|private:|protected:)\s*$|^\s*#|^$")


def header_of(lines, brace):
    """What stands above a lone brace, on one line."""
    first = brace
    while first > 0 and not ENDS_ANOTHER.search(lines[first - 1]):
        first -= 1
    return " ".join(line.strip() for line in lines[first:brace])


def cpp_functions(lines):
    """(line of the opening brace, lines of the body) of each."""
    number = 0
    while number < len(lines):
        indent = re.fullmatch(r"( *)\{", lines[number])
        if indent and not NO_FUNCTION.match(header_of(lines, number)):
            end = next((i for i in range(number + 1, len(lines))
                        if re.match(indent.group(1) + r"\}", lines[i])), len(lines))
            yield number, end - number - 1
            number = end
        number += 1


def python_functions(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            yield node.lineno - 1, node.end_lineno - node.body[0].lineno + 1


def functions(path, text):
    lines = text.splitlines()
    if path.endswith(CPP):
        return cpp_functions(lines)
    return python_functions(text) if path.endswith(".py") or "python" in lines[0] else []


def is_code(path, root):
    if path.endswith(CPP + (".py", ".sh")):
        return True
    return "." not in path.rsplit("/", 1)[-1] and bool(SHEBANG.match(project.text(root, path).split("\n", 1)[0]))


def check(root):
    problems = []
    for top in TOPS:
        for path in project.files(root, top):
            if not is_code(path, root):
                continue
            text = project.text(root, path)
            length = text.count("\n")
            if length > FILE_LINES:
                problems.append(f"{path}:1: {length} lines; a file has at most {FILE_LINES}")
            problems += [f"{path}:{line + 1}: function of {count} lines; it has at most {FUNCTION_LINES}"
                         for line, count in functions(path, text) if count > FUNCTION_LINES]
    return problems


if __name__ == "__main__":
    project.run(check)
