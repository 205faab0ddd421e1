// SPDX-License-Identifier: MIT
#include "init_folder.hpp"

#include "digits.hpp"
#include "rig_input.hpp"

#include <rosin/report/npy.hpp>

namespace tool {

namespace {

namespace fs = std::filesystem;

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

bool is_sound(const fs::path& file) {
  const std::string ending = lower(file.extension().string());
  for (const char* known : {".wav", ".flac", ".rf64", ".w64", ".aif", ".aiff", ".caf"})
    if (ending == known) return true;
  return false;
}

/// take 2 before take 10.
bool natural_less(const std::string& a, const std::string& b) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (digit(a[i]) && digit(b[j])) {
      std::size_t p = i, q = j;
      while (p < a.size() && digit(a[p])) ++p;
      while (q < b.size() && digit(b[q])) ++q;
      const std::string x = a.substr(i, p - i), y = b.substr(j, q - j);
      const auto significant = [](const std::string& s) { return s.substr(std::min(s.find_first_not_of('0'), s.size() - 1)); };
      const std::string u = significant(x), v = significant(y);
      if (u.size() != v.size()) return u.size() < v.size();
      if (u != v) return u < v;
      i = p, j = q;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
    }
  }
  return a.size() - i < b.size() - j;
}

/// * stands for anything, ? for one character.
bool matches(std::string_view pattern, std::string_view text) {
  if (pattern.empty()) return text.empty();
  if (pattern.front() == '*') return matches(pattern.substr(1), text) || (!text.empty() && matches(pattern, text.substr(1)));
  return !text.empty() && (pattern.front() == '?' || pattern.front() == text.front()) &&
         matches(pattern.substr(1), text.substr(1));
}

/// The N of whole_N, if it is one.
std::optional<std::string> machine_number(const fs::path& file) {
  const std::string stem = file.stem().string();
  if (!stem.starts_with("whole_") || stem.size() == 6) return std::nullopt;
  const std::string number = stem.substr(6);
  return number.find_first_not_of("0123456789") == std::string::npos ? std::optional{number} : std::nullopt;
}

bool is_companion(const fs::path& file) {
  const std::string stem = file.stem().string();
  const auto after = stem.starts_with("beta_") ? 5U : stem.starts_with("timestamp_") ? 10U : 0U;
  return after > 0 && stem.size() > after && stem.find_first_not_of("0123456789", after) == std::string::npos;
}

/// A table that rosin wrote as a result is no recording.
bool is_result(const fs::path& file) {
  std::ifstream in{file, std::ios::binary};
  std::array<char, 8> head{};
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  return std::string_view{head.data(), static_cast<std::size_t>(in.gcount())} == "# rosin ";
}

/// The numbers of a small file beside a stroke: so many in one row.
std::optional<std::vector<double>> numbers_in(const fs::path& file, std::size_t count, found_take& one) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return std::nullopt;
  const auto read = rosin::read_table_text(file.string());
  if (!read) {
    one.remarks.push_back(read.error());
    return std::nullopt;
  }
  std::vector<double> out;
  for (const auto& c : read->data.columns) out.insert(out.end(), c.values.begin(), c.values.end());
  if (out.size() == count) return out;
  one.remarks.push_back(file.string() + ": holds " + std::to_string(out.size()) + " number(s) instead of " +
                        std::to_string(count));
  return std::nullopt;
}

void read_companions(found_take& one, const fs::path& file, const std::string& number) {
  one.machine_layout = true, one.kind = "bow";
  const fs::path beside = file.parent_path();
  if (const auto beta = numbers_in(beside / ("beta_" + number + ".csv"), 1, one)) {
    if (beta->front() > 0 && beta->front() < 1) one.beta = beta->front();
    else one.remarks.push_back("beta_" + number + ".csv: " + in_digits(beta->front()) + " is no place between the ends");
  }
  if (const auto span = numbers_in(beside / ("timestamp_" + number + ".csv"), 2, one)) {
    if ((*span)[0] >= 0 && (*span)[1] > (*span)[0]) one.steady_samples = {(*span)[0], (*span)[1]};
    else one.remarks.push_back("timestamp_" + number + ".csv: ends before it begins");
  }
}

std::string kind_by(const std::string& name) {
  const std::string text = lower(name);
  for (const auto& [part, kind] : {std::pair{"pluck", "pluck"},
                                   {"quiet", "quiet"},
                                   {"noise", "quiet"},
                                   {"silence", "quiet"},
                                   {"bow", "bow"},
                                   {"stroke", "bow"}})
    if (text.find(part) != std::string::npos) return kind;
  return {};
}

/// Where a table has its binary form beside it, and that is not older, the binary form is the recording.
bool has_newer_binary(const fs::path& text) {
  if (text.extension() == ".npy") return false;
  fs::path binary = text;
  binary.replace_extension(".npy");
  std::error_code error;
  return fs::exists(binary, error) && fs::last_write_time(binary, error) >= fs::last_write_time(text, error) && !error;
}
bool is_older_binary(const fs::path& file) {
  if (file.extension() != ".npy") return false;
  for (const char* ending : {".csv", ".tsv"}) {
    fs::path text = file;
    text.replace_extension(ending);
    std::error_code error;
    if (fs::exists(text, error) && fs::last_write_time(file, error) < fs::last_write_time(text, error)) return true;
  }
  return false;
}

rosin::outcome<std::vector<fs::path>> files_below(const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) return rosin::failure{folder + ": no such folder"};
  std::vector<fs::path> out;
  fs::recursive_directory_iterator at{folder, fs::directory_options::skip_permission_denied, error}, end;
  for (; !error && at != end; at.increment(error)) {
    const fs::path& file = at->path();
    if (file.filename().string().starts_with('.')) {
      at.disable_recursion_pending();
      continue;
    }
    std::error_code ignored;
    const bool table = !rosin::table_ending(file.string()).empty() && !is_companion(file);
    if (at->is_regular_file(ignored) && (table || is_sound(file)) && !(table && has_newer_binary(file)) && !is_older_binary(file))
      out.push_back(file);
  }
  if (error) return rosin::failure{folder + ": " + error.message()};
  return out;
}

bool wanted(const found_take& one, const init_request& given) {
  const auto fits = [&](const std::string& pattern) { return matches(pattern, one.name); };
  if (!given.takes.empty() && std::none_of(given.takes.begin(), given.takes.end(), fits)) return false;
  return !given.beta || (one.beta && *one.beta >= given.beta->first && *one.beta <= given.beta->second);
}

std::string relative_to(const fs::path& file, const std::string& folder) {
  std::error_code error;
  const fs::path out = fs::proximate(file, folder, error);
  return (error ? file : out).generic_string();
}

rosin::sensor_channel machine_channel(int index) {
  constexpr std::array names{"normal", "bow", "near", "far"};
  constexpr std::array what{rosin::quantity::normal_force, rosin::quantity::bow_speed, rosin::quantity::termination_force,
                            rosin::quantity::termination_force};
  rosin::sensor_channel out;
  out.name = names[static_cast<std::size_t>(index)], out.index = index, out.quantity = what[static_cast<std::size_t>(index)];
  out.per_full_scale = 1;
  return out;
}

/// The checks of a stroke that need no string; an error leaves it out.
void check_stroke(found_take& one, const rosin::recording& read) {
  rosin::rig rig;
  for (int i = 0; i < 4; ++i) rig.channels.push_back(machine_channel(i));
  rosin::take take;
  take.name = one.name, take.kind = rosin::take_kind::bow, take.contact_position = one.beta;
  if (one.steady_samples)
    take.steady_s = {one.steady_samples->first / read.sample_rate_Hz, one.steady_samples->second / read.sample_rate_Hz};
  const auto signals = rosin::signals_of(rig, take, read);
  if (!signals) {
    one.problem = signals.error();
    return;
  }
  rosin::take_check check{one.name, one.path, read.sample_rate_Hz, read.duration_s(), {}, {}, {}, {}, {}, {}};
  bool sound = true;
  for (const auto& s : signals->signals) sound = rosin::detail::check_signal(check, *signals, s, false) && sound;
  one.motion = rosin::motion_of(take, *signals);
  const auto mean = [&](std::size_t c) { return sound ? check.channels[c].mean : 0.0; };
  rosin::detail::check_motion(check, *signals, one.motion, std::abs(mean(2) + mean(3)));
  rosin::detail::check_end_columns(check, rig, take, mean(2), mean(3));
  one.motion.speed_m_s.clear(), one.motion.normal_force_N.clear();
  for (const auto& f : check.findings) {
    const std::string text = (f.channel.empty() ? "" : "channel " + f.channel + ": ") + f.what + "; " + f.advice;
    if (f.level == rosin::severity::error) one.problem += (one.problem.empty() ? one.path + ": " : "; ") + text;
    else if (f.level == rosin::severity::warning) one.remarks.push_back(text);
  }
}

void keep_binary(found_take& one, const rosin::recording& read, const init_request& given) {
  if (fs::path{one.path}.extension() == ".npy") return;
  rosin::table out;
  for (std::size_t c = 0; c < read.channels.size(); ++c)
    out.add(one.machine_layout        ? machine_columns[c]
            : read.columns[c].empty() ? "column_" + std::to_string(c + 1)
                                      : read.columns[c],
            read.channels[c]);
  const fs::path place =
      given.out.empty() ? fs::path{one.path}.replace_extension(".npy") : fs::path{given.out} / (one.name + ".npy");
  const auto existing = given.force ? rosin::overwrite::allow : rosin::overwrite::refuse;
  if (const auto why = rosin::save_npy(place.string(), out, existing))
    one.problem = why->message + " (the binary form of " + one.path + ")";
  else one.file = relative_to(place, given.rig_folder());
}

/// The column that a header calls a time.
std::optional<int> time_among(const std::vector<std::string>& names) {
  for (std::size_t c = 0; c < names.size(); ++c) {
    const std::string name = lower(names[c]);
    if (name == "t" || name == "t_s" || name.starts_with("time")) return static_cast<int>(c);
  }
  return std::nullopt;
}

}  // namespace

rosin::outcome<std::vector<found_take>> find_recordings(const init_request& given, std::vector<std::string>& notes) {
  const auto files = files_below(given.folder);
  if (!files) return rosin::failure{files.error()};
  std::vector<found_take> all;
  for (const fs::path& file : *files) {
    found_take one;
    one.path = file.string(), one.file = relative_to(file, given.rig_folder());
    one.is_table = !rosin::table_ending(one.path).empty();
    if (one.is_table && is_result(file)) {
      notes.push_back(one.path + ": is a result of rosin, no recording");
      continue;
    }
    one.name = fs::path{relative_to(file, given.folder)}.replace_extension().generic_string();
    for (char& c : one.name)
      if (c == '/' || c == '\\') c = '-';
    one.kind = kind_by(one.name);
    if (const auto number = machine_number(file); number && one.is_table) read_companions(one, file, *number);
    all.push_back(std::move(one));
  }
  if (all.empty()) return rosin::failure{given.folder + ": holds no recordings (WAV, FLAC, CSV, TSV, NPY, MAT, HDF5)"};
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return natural_less(a.name, b.name); });
  for (std::size_t i = 1; i < all.size(); ++i)  // a.wav and a.csv
    if (all[i].name == all[i - 1].name) all[i].name += "-" + fs::path{all[i].path}.extension().string().substr(1);
  const std::size_t there = all.size();
  std::erase_if(all, [&](const found_take& one) { return !wanted(one, given); });
  std::vector<found_take> out;
  for (std::size_t i = 0; i < all.size(); i += given.every) out.push_back(std::move(all[i]));
  if (out.empty())
    return rosin::failure{given.folder + ": none of its " + std::to_string(there) + " recordings is one that was asked for"};
  return out;
}

void examine(found_take& one, const init_request& given) {
  rosin::outcome<rosin::recording> read = rosin::failure{""};
  if (one.is_table) {
    auto table = rosin::read_table(one.path, table_formats());
    if (!table) {
      one.problem = table.error();
      return;
    }
    std::vector<std::string> names;
    for (const auto& c : table->data.columns) names.push_back(c.name);
    if (one.machine_layout && names.size() != machine_columns.size()) {
      one.problem = one.path + ": has " + std::to_string(names.size()) +
                    " column(s) instead of normal force, bow speed, near and far force";
      return;
    }
    const auto time = one.machine_layout ? std::nullopt : time_among(names);
    rosin::table_clock clock{std::nullopt, time};
    if (!time) clock.rate_Hz = machine_rate_Hz;
    read = rosin::recording_of(*std::move(table), one.path, clock);
    if (read && (time || one.machine_layout)) one.rate_Hz = read->sample_rate_Hz;
  } else {
    read = rosin::read_audio(one.path);
    if (read) one.rate_Hz = read->sample_rate_Hz;
  }
  if (!read) {
    one.problem = read.error();
    return;
  }
  one.frames = read->frames();
  for (std::size_t c = 0; c < read->channels.size(); ++c) {
    const auto& x = read->channels[c];
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    double mean = 0;
    for (const double v : x) mean += v / static_cast<double>(x.size());
    one.columns.push_back({c < read->columns.size() ? read->columns[c] : std::string{}, *low, *high, mean});
  }
  if (one.machine_layout) {
    if (one.steady_samples && one.steady_samples->second > static_cast<double>(one.frames)) {
      one.remarks.push_back("its timestamps end at sample " + in_digits(one.steady_samples->second, "%.0f") + ", it has " +
                            std::to_string(one.frames) + ": left out");
      one.steady_samples.reset();
    }
    check_stroke(one, *read);
  }
  if (one.problem.empty() && given.binary && one.is_table) keep_binary(one, *read, given);
}

}  // namespace tool
