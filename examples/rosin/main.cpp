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

#include <rosin/adapt/problem_log.hpp>
#include <rosin/version.hpp>

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

/// /dev/stdout and its other names are "-" to whatever takes the name of a file.
void know_standard_output(CLI::App& command) {
  for (CLI::Option* option : command.get_options({}))
    if (option->get_type_name().find("FILE") != std::string::npos && !option->get_positional())
      option->transform([](const std::string& path) { return rosin::is_standard_output(path) ? std::string{"-"} : path; });
}

/// "; did you mean --json?": a command or an option of the one that was given, whose name is near.
std::string meant(const CLI::App& app, const std::string& unknown) {
  const auto chosen = app.get_subcommands();
  std::vector<std::string> known;
  if (chosen.empty())
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
      known.push_back(command->get_name());
  else if (unknown.starts_with("--"))
    for (const CLI::Option* option : chosen.front()->get_options())
      for (const auto& name : option->get_lnames()) known.push_back("--" + name);
  return rosin::suggestion(unknown.substr(0, unknown.find('=')), known);
}

/// What nobody asked for, one thing a line.
tool::exit_code tell_unexpected(const CLI::App& app) {
  std::string text;
  for (const auto& unknown : app.remaining(true)) {
    const bool command = app.get_subcommands().empty() && !unknown.starts_with('-');
    const std::string what = command                    ? "there is no command "
                             : unknown.starts_with('-') ? "there is no option "
                                                        : "not expected: ";
    text += (text.empty() ? "" : "\n") + what + unknown + meant(app, unknown);
    if (command) break;  // what follows is that command's
  }
  return tool::fail(text);
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
  for (CLI::App* command : app.get_subcommands({})) know_standard_output(*command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked = error.get_exit_code() == 0;  // for help or the version
    if (!app.remaining(true).empty() && (!asked || app.get_subcommands().empty())) return tell_unexpected(app);
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
