#pragma once

#include "app/command_line.h"
#include "core/error.h"

namespace retrace::app {

// One function a command. Each returns the exit code or throws retrace::Error.

ExitCode run_rre_command(const CommandLine& line);
ExitCode run_photometry_command(const CommandLine& line);
ExitCode run_roughness_command(const CommandLine& line);
ExitCode run_inspect_command(const CommandLine& line);
ExitCode run_metrology_command(const CommandLine& line);
ExitCode run_sweep_command(const CommandLine& line);
ExitCode run_job_command(const CommandLine& line);
ExitCode run_fabricate_command(const CommandLine& line);
ExitCode run_optimize_command(const CommandLine& line);
ExitCode run_tolerance_command(const CommandLine& line);
ExitCode run_verify_command(const CommandLine& line);
ExitCode run_plane_command(const CommandLine& line);
ExitCode run_forces_command(const CommandLine& line);
ExitCode run_turn_command(const CommandLine& line);
ExitCode run_image_command(const CommandLine& line);
ExitCode run_export_command(const CommandLine& line);
ExitCode run_report_command(const CommandLine& line);
ExitCode run_init_command(const CommandLine& line);
ExitCode run_list_command(const CommandLine& line);
ExitCode run_schema_command(const CommandLine& line);

}  // namespace retrace::app
