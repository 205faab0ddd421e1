// SPDX-License-Identifier: MIT
//
// The formats as JSON documents, which is what their schemas describe (docs/formats/).
//
#pragma once

#include "command_line.hpp"

#include <functional>

namespace tool {

enum class format { rig, reconstruction, diagnosis, calibration };
[[nodiscard]] std::string name_of(format what);

/// A file's JSON image, and how to say where in the file a place of the image is ("rig.toml:12").
struct json_image {
  format kind;
  json document;
  std::function<std::string(const std::string& pointer)> place;
};

/// By the file's name: .toml, .csv or .json. The reason if it cannot be read.
[[nodiscard]] rosin::outcome<json_image> read_json_image(const std::string& path);

/// The text of the JSON Schema, as it stands in docs/formats/.
[[nodiscard]] std::string schema_text(format what);

}  // namespace tool
