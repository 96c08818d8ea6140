#include "server/cli/cli_app.h"
#include "server/cli/inquiry/command_line.h"

int main(int argc, char** argv) {
  return slipway::server::run_program(argc, argv, &slipway::server::run_command_line);
}
