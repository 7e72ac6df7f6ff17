# cmake --install, and cpack for a .deb: the program, what it says of itself, the scenes that ship, and the documents.

include(GNUInstallDirs)
set(described ${CMAKE_BINARY_DIR}/described)
file(MAKE_DIRECTORY ${described})
foreach(pair IN ITEMS man:unravel.1 completion:unravel.bash)
  string(REPLACE ":" ";" pair ${pair})
  list(GET pair 0 what)
  list(GET pair 1 file)
  add_custom_command(
    OUTPUT ${described}/${file}
    COMMAND sh -c "$<TARGET_FILE:unravel> describe ${what} > ${described}/${file}"
    DEPENDS unravel
    VERBATIM)
  list(APPEND descriptions ${described}/${file})
endforeach()
add_custom_target(descriptions ALL DEPENDS ${descriptions})

install(TARGETS unravel RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES ${described}/unravel.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${described}/unravel.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME unravel)
# Where tool/base/program.cpp looks for them.
install(DIRECTORY scenes DESTINATION share/unravel FILES_MATCHING PATTERN "*.toml" PATTERN "*.obj" PATTERN "*.png" PATTERN "*.py")
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
# A rival that few want, with CHOLMOD and its BLAS: cmake --install DIR --component rivals.
if(TARGET unravel_cholmod)
  install(TARGETS unravel_cholmod LIBRARY DESTINATION lib/unravel COMPONENT rivals EXCLUDE_FROM_ALL)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME unravel)
set(CPACK_PACKAGE_CONTACT "the authors of Unravel")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "cloth simulated with a decomposing solver, rendered off-screen")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
# Opened at run time, so that no library of the program names them.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libegl1, libgl1-mesa-dri")
find_program(DPKG_SHLIBDEPS dpkg-shlibdeps)  # of dpkg-dev
if(DPKG_SHLIBDEPS)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
endif()
include(CPack)
