// SPDX-License-Identifier: MIT
//
// The subcommands of the tool, one source file each. How to add one stands in main.cpp.
//
#pragma once

#include "command_line.hpp"

namespace tool {

void add_challenge(CLI::App& app, exit_code& result);
void add_check(CLI::App& app, exit_code& result);
void add_compare(CLI::App& app, exit_code& result);
void add_diagnose(CLI::App& app, exit_code& result);
void add_fit(CLI::App& app, exit_code& result);
void add_record(CLI::App& app, exit_code& result);
void add_init(CLI::App& app, exit_code& result);
void add_live(CLI::App& app, exit_code& result);
void add_fake_rig(CLI::App& app, exit_code& result);
void add_reconstruct(CLI::App& app, exit_code& result);
void add_simulate(CLI::App& app, exit_code& result);
void add_sweep(CLI::App& app, exit_code& result);
void add_validate(CLI::App& app, exit_code& result);

}  // namespace tool
