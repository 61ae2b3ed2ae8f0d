// The subcommands. Each function adds one to the app with help, options and a callback. A user's
// mistake is thrown as sinew::Error; `status` is the exit code of a command that ends without one.
#pragma once

#include <CLI/CLI.hpp>

void add_run(CLI::App& app, int& status);
void add_resume(CLI::App& app, int& status);
void add_info(CLI::App& app);
void add_convert(CLI::App& app);
void add_repair(CLI::App& app);
void add_materials(CLI::App& app);
void add_identify(CLI::App& app);
void add_validate(CLI::App& app, int& status);
void add_converge(CLI::App& app, int& status);
void add_study(CLI::App& app);
void add_calibrate(CLI::App& app);
void add_bench(CLI::App& app, int& status);
void add_view(CLI::App& app, int& status);
void add_feel(CLI::App& app, int& status);
void add_completion(CLI::App& app);
