// SPDX-License-Identifier: MIT
//
// rosin validate: a rig file, a reconstruction, a diagnosis or a calibration against the JSON Schema of its format.
//
#include "commands.hpp"
#include "json_image.hpp"
#include "provenance.hpp"

#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include <iostream>
#include <memory>

namespace tool {

namespace {

struct validate_options {
  std::string file, print_schema;
  bool json = false;
};

struct violation {
  std::string place, pointer, reason;
};

/// "<root>", "[take]", "[0]" to "/take/0".
std::string pointer_of(const std::vector<std::string>& context) {
  std::string out;
  for (const auto& step : context)
    if (step.size() > 2 && step.front() == '[') out += "/" + step.substr(1, step.size() - 2);
  return out.empty() ? "/" : out;
}

std::vector<violation> violations_of(const json_image& image) {
  // valijson's adapter is for the unordered kind of document
  const auto schema_document = nlohmann::json::parse(schema_text(image.kind));
  const auto document = nlohmann::json::parse(image.document.dump());
  valijson::Schema schema;
  valijson::SchemaParser{}.populateSchema(valijson::adapters::NlohmannJsonAdapter{schema_document}, schema);
  valijson::Validator validator;
  valijson::ValidationResults results;
  std::vector<violation> out;
  if (validator.validate(schema, valijson::adapters::NlohmannJsonAdapter{document}, &results)) return out;
  for (const auto& error : results) {
    const std::string pointer = pointer_of(error.context);
    out.push_back({image.place(pointer), pointer, error.description});
  }
  return out;
}

exit_code run(const validate_options& given, provenance from) {
  if (const auto why = from.add_input(given.file)) return fail(why->message, given.json);
  const auto image = read_json_image(given.file);
  if (!image) return fail(image.error(), given.json);
  const auto violations = violations_of(*image);
  if (given.json) {
    json out{{"schema", 1}, {"provenance", from.to_json()}, {"format", name_of(image->kind)}, {"valid", violations.empty()}};
    out["violations"] = json::array();
    for (const auto& v : violations)
      out["violations"].push_back({{"place", v.place}, {"pointer", v.pointer}, {"reason", v.reason}});
    print(out);
  } else {
    for (const auto& v : violations) std::cout << v.place << ": " << v.pointer << ": " << v.reason << '\n';
    std::cout << given.file << (violations.empty() ? ": a valid " : ": not a valid ") << name_of(image->kind) << '\n';
  }
  return violations.empty() ? exit_code::ok : exit_code::finding;
}

exit_code print_schema(const std::string& name) {
  for (const auto what : {format::rig, format::reconstruction, format::diagnosis, format::calibration})
    if (name == name_of(what)) std::cout << schema_text(what);
  return exit_code::ok;
}

}  // namespace

void add_validate(CLI::App& app, exit_code& result) {
  auto given = std::make_shared<validate_options>();
  CLI::App* command = app.add_subcommand("validate", "Check a file against the JSON Schema of its format");
  auto* file =
      command->add_option("FILE", given->file, "A rig (.toml), a reconstruction (.csv), a diagnosis or a calibration (.json)");
  auto* schema = command
                     ->add_option("--print-schema", given->print_schema,
                                  "Print a schema instead: rig, reconstruction, diagnosis or calibration")
                     ->check(CLI::IsMember({"rig", "reconstruction", "diagnosis", "calibration"}));
  file->excludes(schema);
  add_json_option(*command, given->json);
  command->footer(
      "The schemas describe JSON: a rig file as tables and lists, a reconstruction as its comments, the names of its\n"
      "columns and for each of them the number of values and of empty fields, and the extremes.\n"
      "Exit status: 0 valid, 1 not valid, 2 cannot be read.");
  command->callback([given, command, &result] {
    if (!given->print_schema.empty()) result = print_schema(given->print_schema);
    else if (given->file.empty()) throw CLI::RequiredError("FILE");
    else result = run(*given, provenance{*command});
  });
}

}  // namespace tool
