# What is installed, and where the program finds its data before it is: share/retrace beside bin/, in both places.

file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/share")
file(CREATE_LINK "${PROJECT_SOURCE_DIR}/data" "${PROJECT_BINARY_DIR}/share/retrace" SYMBOLIC)

install(TARGETS retrace RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
# Not CMAKE_INSTALL_DATADIR, which may be moved: the program looks for this folder relative to itself.
install(DIRECTORY "${PROJECT_SOURCE_DIR}/data/" DESTINATION share/retrace)
install(FILES "${PROJECT_SOURCE_DIR}/docs/man/retrace.1" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1")
install(FILES "${PROJECT_SOURCE_DIR}/tools/completion/retrace.bash" DESTINATION share/bash-completion/completions
        RENAME retrace)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/README.md" "${PROJECT_SOURCE_DIR}/CHANGELOG.md"
              "${PROJECT_SOURCE_DIR}/CONVENTIONS.md" "${PROJECT_SOURCE_DIR}/THIRD-PARTY-NOTICES.md"
        DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs" DESTINATION "${CMAKE_INSTALL_DOCDIR}" PATTERN man EXCLUDE)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/examples" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
