# Writes a C++ file that holds the text of other files, so that the program has them with it.
#   cmake -DOUT=FILE.cpp -DHEADER=include/path.h -DNAMESPACE=a::b "-DNAMES=name,..."
#         "-DFILES=path,..." -P embed.cmake
# SPDX-License-Identifier: LGPL-3.0-or-later
string(REPLACE "," ";" names "${NAMES}")
string(REPLACE "," ";" files "${FILES}")
set(text "// Written by embed.cmake.\n#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\n")
foreach(name file IN ZIP_LISTS names files)
  file(READ "${file}" content)
  # The literal would end here.
  string(FIND "${content}" ")incise_part\"" end)
  if(NOT end EQUAL -1)
    message(FATAL_ERROR "${file}: must not contain )incise_part\"")
  endif()
  string(APPEND text
    "const std::string_view ${name} = R\"incise_part(${content})incise_part\";\n")
endforeach()
string(APPEND text "}  // namespace ${NAMESPACE}\n")
file(WRITE "${OUT}" "${text}")
