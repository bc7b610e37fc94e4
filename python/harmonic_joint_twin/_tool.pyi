# SPDX-License-Identifier: BSD-3-Clause
from typing import List, Tuple

def run(arguments: List[str]) -> Tuple[int, str, str]: ...
