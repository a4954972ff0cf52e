# CPack's script before a package is built: Debian's Python of /usr looks for modules in
# lib/python3/dist-packages, and that of /usr/local in lib/python3.11/dist-packages, to which
# `cmake --install` puts the module.
file(GLOB folders ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/lib/python3.*)
foreach(folder IN LISTS folders)
  file(MAKE_DIRECTORY ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/lib/python3/dist-packages)
  file(RENAME ${folder}/dist-packages/incise
    ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/lib/python3/dist-packages/incise)
  file(REMOVE_RECURSE ${folder})
endforeach()
