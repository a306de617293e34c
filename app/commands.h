#pragma once

// List of all commands of the program. Each command is defined in a separate file in app/commands/.

#include <span>

#include "app/command.h"

namespace retrace::app {

/// Returns all commands, in the order in which help lists them.
std::span<const Command> commands();

// Functions that return the description of one command each.

Command completion_command();
Command explore_command();
Command export_command();
Command fabricate_command();
Command forces_command();
Command image_command();
Command init_command();
Command inspect_command();
Command job_command();
Command list_command();
Command manual_command();
Command metrology_command();
Command optimize_command();
Command compose_command();
Command photometry_command();
Command plane_command();
Command ranging_command();
Command rays_command();
Command report_command();
Command roughness_command();
Command rre_command();
Command schema_command();
Command sweep_command();
Command tolerance_command();
Command turn_command();
Command validate_command();
Command verify_command();
Command calibrate_command();
Command correct_command();

}  // namespace retrace::app
