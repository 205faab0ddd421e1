// SPDX-License-Identifier: MIT
//
// rosin, the command line tool. To add a subcommand `name`:
//
//   1. name.cpp beside this file defines  void tool::add_name(CLI::App& app, exit_code& result).  It adds the subcommand
//      with its options to `app` and sets a callback that does the work and puts its outcome into `result`:
//
//          struct options { std::string rig; bool json = false; };
//          void add_name(CLI::App& app, exit_code& result) {
//            auto given = std::make_shared<options>();
//            CLI::App* command = app.add_subcommand("name", "What it does, in one line");
//            command->add_option("RIG", given->rig, "Rig file, or the folder that holds it")->required();
//            add_json_option(*command, given->json);
//            command->callback([given, command, &result] { result = run(*given, provenance{*command}); });
//          }
//
//   2. commands.hpp declares it, and the list below names it. The build finds the source by itself.
//
// Shared: command_line.hpp (exit codes, fail(), --json, --out/--format/--force), provenance.hpp (version, inputs with
// checksums, options), rig_input.hpp (rig and takes, read and checked), progress.hpp.
// Rules: results to standard output or --out, messages to standard error; --json wherever a program could read the result;
// nothing is overwritten without --force; exit 0 done, 1 something was found, 2 bad input or usage.
//
#include "commands.hpp"

#include <rosin/version.hpp>

#include <cmath>
#include <exception>
#include <iostream>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace {

/// Fits ask for the same few hundred kilobytes again and again. Where they go back to the system each time they return as page
/// faults, a fifth of the time of a diagnosis.
void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
}

/// "nan" is a number that no comparison refuses: neither is it too large nor too small for a range.
void ask_for_finite_numbers(CLI::App& command) {
  const CLI::Validator finite{[](const std::string& text) {
                                double value = 0;
                                const bool number = CLI::detail::lexical_cast(text, value);
                                return number && !std::isfinite(value) ? text + " is no finite number" : std::string{};
                              },
                              ""};
  for (CLI::Option* option : command.get_options({}))
    if (const auto& takes = option->get_type_name(); takes.find("POSITIVE") != std::string::npos ||
                                                     takes.find("NONNEGATIVE") != std::string::npos ||
                                                     takes.find(" in [") != std::string::npos)
      option->check(finite);
}

tool::exit_code run(int argc, char** argv) {
  auto result = tool::exit_code::ok;
  CLI::App app{"Friction force and string velocity under the bow, from the forces at the string's ends", "rosin"};
  app.set_version_flag("--version", "rosin " ROSIN_VERSION_STRING);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  app.footer("rosin COMMAND --help explains a command.\nExit status: 0 done, 1 something was found, 2 bad input or usage.");
  tool::add_init(app, result);
  tool::add_check(app, result);
  tool::add_record(app, result);
  tool::add_live(app, result);
  tool::add_fake_rig(app, result);
  tool::add_fit(app, result);
  tool::add_reconstruct(app, result);
  tool::add_diagnose(app, result);
  tool::add_simulate(app, result);
  tool::add_sweep(app, result);
  tool::add_compare(app, result);
  tool::add_challenge(app, result);
  tool::add_validate(app, result);
  for (CLI::App* command : app.get_subcommands({})) ask_for_finite_numbers(*command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? tool::exit_code::ok : tool::exit_code::bad_input;
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  try {
    return static_cast<int>(run(argc, argv));
  } catch (const std::exception& error) {
    std::cerr << "rosin: " << error.what() << '\n';
    return static_cast<int>(tool::exit_code::bad_input);
  }
}
