# SPDX-License-Identifier: BSD-3-Clause
# Writes what TOOL says to --help into OUT, as a string literal of C++.
execute_process(COMMAND ${TOOL} --help OUTPUT_VARIABLE HELP RESULT_VARIABLE RESULT)
if(NOT RESULT EQUAL 0)
  message(FATAL_ERROR "${TOOL} --help: ${RESULT}")
endif()
file(WRITE ${OUT} "R\"help(${HELP})help\"\n")
