# SPDX-License-Identifier: BSD-3-Clause
# A hash of source files as a C++ constant, renewed by the build when one of them changes.
#
#   add_source_hash(TARGET FUNCTION FOLDER...)
#
# gives TARGET the function `const char* hjt::FUNCTION()`, declared in base/hash.hpp: 16 hexadecimal digits of all
# sources and headers below the folders, the compiler and its options. Run as a script, this file writes the function.
if(CMAKE_SCRIPT_MODE_FILE)
  file(STRINGS ${LIST} ENTRIES)
  list(POP_FRONT ENTRIES TEXT)
  foreach(ENTRY ${ENTRIES})
    file(SHA256 ${ROOT}/${ENTRY} HASH)
    string(APPEND TEXT " ${ENTRY} ${HASH}")
  endforeach()
  string(SHA256 HASH "${TEXT}")
  string(SUBSTRING ${HASH} 0 16 HASH)
  set(CODE "// Written by cmake/source_hash.cmake.
#include \"base/hash.hpp\"

const char* hjt::${FUNCTION}()
{
  return \"${HASH}\";
}
")
  # Only a file that is another makes the library link again.
  if(EXISTS "${OUTPUT}")
    file(READ ${OUTPUT} FOUND)
  endif()
  if(NOT "${FOUND}" STREQUAL "${CODE}")
    file(WRITE ${OUTPUT} "${CODE}")
  endif()
  return()
endif()

set(SOURCE_HASH_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

function(add_source_hash TARGET FUNCTION)
  set(PATTERNS)
  foreach(FOLDER ${ARGN})
    foreach(SUFFIX cpp hpp ipp msg)
      list(APPEND PATTERNS ${PROJECT_SOURCE_DIR}/${FOLDER}/*.${SUFFIX})
    endforeach()
  endforeach()
  file(GLOB_RECURSE FILES CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${PATTERNS})
  list(SORT FILES)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" TYPE)
  set(TOOLS "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} ${CMAKE_SYSTEM_PROCESSOR} ${CMAKE_CXX_FLAGS} \
${CMAKE_CXX_FLAGS_${TYPE}} ${LOOP_OPTIONS} Eigen ${EIGEN3_VERSION_STRING} Boost ${Boost_VERSION}")
  set(NAME ${PROJECT_BINARY_DIR}/source_hash/${FUNCTION})
  string(REPLACE ";" "\n" LINES "${FILES}")
  string(REPLACE ";" " " TOOLS "${TOOLS}")
  file(GENERATE OUTPUT ${NAME}.txt CONTENT "${TOOLS}\n${LINES}\n")
  list(TRANSFORM FILES PREPEND ${PROJECT_SOURCE_DIR}/)
  # The stamp says that the file has been looked at, the file itself when it last changed.
  add_custom_command(OUTPUT ${NAME}.stamp BYPRODUCTS ${NAME}.cpp
    COMMAND ${CMAKE_COMMAND} -DLIST=${NAME}.txt -DROOT=${PROJECT_SOURCE_DIR} -DFUNCTION=${FUNCTION}
      -DOUTPUT=${NAME}.cpp -P ${SOURCE_HASH_SCRIPT}
    COMMAND ${CMAKE_COMMAND} -E touch ${NAME}.stamp
    DEPENDS ${FILES} ${NAME}.txt ${SOURCE_HASH_SCRIPT} COMMENT "Hash of the sources: ${FUNCTION}" VERBATIM)
  add_custom_target(${PROJECT_NAME}_${FUNCTION} DEPENDS ${NAME}.stamp)
  # Alone, since it changes with every source.
  set_source_files_properties(${NAME}.cpp PROPERTIES GENERATED TRUE SKIP_UNITY_BUILD_INCLUSION ON)
  target_sources(${TARGET} PRIVATE ${NAME}.cpp)
  add_dependencies(${TARGET} ${PROJECT_NAME}_${FUNCTION})
endfunction()
