# Run by CPack when the packages' files are in their places: the list of the program's parts goes beside its pages.
execute_process(COMMAND_ERROR_IS_FATAL ANY
  COMMAND ${CPACK_SLIPWAY_PARTS} ${CPACK_TEMPORARY_DIRECTORY}/tools/usr/share/doc/slipway/slipway.spdx.json)
