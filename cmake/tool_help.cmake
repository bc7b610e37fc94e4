# SPDX-License-Identifier: BSD-3-Clause
# What a program says to --help, as a C++ constant of another.
#
#   add_tool_help(TARGET PROGRAM)
#
# gives TARGET the function `const char* hjt::toolHelp()`. Run as a script, this file writes the function.
if(CMAKE_SCRIPT_MODE_FILE)
  execute_process(COMMAND ${PROGRAM} --help OUTPUT_VARIABLE HELP RESULT_VARIABLE RESULT)
  if(NOT RESULT EQUAL 0)
    message(FATAL_ERROR "${PROGRAM} --help: ${RESULT}")
  endif()
  file(WRITE ${OUTPUT} "// Written by cmake/tool_help.cmake.
namespace hjt
{
const char* toolHelp();
const char* toolHelp()
{
  return R\"help(${HELP})help\";
}
}  // namespace hjt
")
  return()
endif()

function(add_tool_help TARGET PROGRAM)
  set(SCRIPT ${PROJECT_SOURCE_DIR}/cmake/tool_help.cmake)
  set(OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/tool_help.cpp)
  add_custom_command(OUTPUT ${OUTPUT}
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${PROGRAM}> -DOUTPUT=${OUTPUT} -P ${SCRIPT}
    DEPENDS ${PROGRAM} ${SCRIPT} VERBATIM)
  target_sources(${TARGET} PRIVATE ${OUTPUT})
endfunction()
