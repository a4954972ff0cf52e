# Writes a C++ file that holds the text of other files, so that the program has them with it.
#   cmake -DOUT=FILE.cpp "-DNAMES=name,..." "-DFILES=path,..." -P embed.cmake
# SPDX-License-Identifier: LGPL-3.0-or-later
string(REPLACE "," ";" names "${NAMES}")
string(REPLACE "," ";" files "${FILES}")
set(text "// Written by embed.cmake.\n#include \"incise/app/report/page_parts.h\"\n\n")
string(APPEND text "namespace incise::report::page_parts {\n")
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
string(APPEND text "}  // namespace incise::report::page_parts\n")
file(WRITE "${OUT}" "${text}")
