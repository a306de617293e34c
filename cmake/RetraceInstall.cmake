# Defines which files are installed. The program finds its data in share/retrace next to bin/, both in the build folder
# and after installation.

file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/share")
file(CREATE_LINK "${PROJECT_SOURCE_DIR}/data" "${PROJECT_BINARY_DIR}/share/retrace" SYMBOLIC)

install(TARGETS retrace RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
# CMAKE_INSTALL_DATADIR is not used because users may change it, but the program searches for this folder relative to
# its own position.
install(DIRECTORY "${PROJECT_SOURCE_DIR}/data/" DESTINATION share/retrace)

# The program prints its own manual page and its shell completions, which are installed.
set(printed "${PROJECT_BINARY_DIR}/printed")
file(MAKE_DIRECTORY "${printed}")
file(GLOB named CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/data/machines/*" "${PROJECT_SOURCE_DIR}/data/processes/*")
add_custom_command(
  OUTPUT "${printed}/retrace.1" "${printed}/retrace" "${printed}/_retrace" "${printed}/retrace.fish"
  COMMAND retrace manual --quiet --out "${printed}/retrace.1"
  COMMAND retrace completion bash --quiet --out "${printed}/retrace"
  COMMAND retrace completion zsh --quiet --out "${printed}/_retrace"
  COMMAND retrace completion fish --quiet --out "${printed}/retrace.fish"
  DEPENDS retrace ${named} "${PROJECT_SOURCE_DIR}/data/photometry_limits.csv"
  COMMENT "Printing the manual page and completion" VERBATIM)

# JSON schemas for editors. `retrace init --editor` searches for them in share/retrace_schemas next to bin/.
set(schemas "${PROJECT_BINARY_DIR}/share/retrace_schemas")
file(MAKE_DIRECTORY "${schemas}")
set(schema_files "")
foreach(format IN ITEMS cubes design job machine materials planed_part process study turned_part)
  add_custom_command(
    OUTPUT "${schemas}/${format}.schema.json"
    COMMAND retrace schema ${format} --quiet --out "${schemas}"
    DEPENDS retrace VERBATIM)
  list(APPEND schema_files "${schemas}/${format}.schema.json")
endforeach()
install(FILES ${schema_files} DESTINATION share/retrace_schemas)

add_custom_target(retrace_printed ALL DEPENDS "${printed}/retrace.1" ${schema_files})
install(FILES "${printed}/retrace.1" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1")
install(FILES "${printed}/retrace" DESTINATION share/bash-completion/completions)
install(FILES "${printed}/_retrace" DESTINATION share/zsh/site-functions)
install(FILES "${printed}/retrace.fish" DESTINATION share/fish/vendor_completions.d)

install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/README.md" "${PROJECT_SOURCE_DIR}/CHANGELOG.md"
              "${PROJECT_SOURCE_DIR}/CONVENTIONS.md" "${PROJECT_SOURCE_DIR}/THIRD-PARTY-NOTICES.md"
        DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/examples" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
