// SPDX-License-Identifier: MIT
#include <rosin/adapt/table_recording.hpp>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>

namespace adapt_table_recording {

namespace {

rosin::number_table timed(std::vector<double> times) {
  rosin::number_table out;
  std::vector<double> x(times.size(), 1);
  out.data.add("t", std::move(times));
  out.data.add("x", std::move(x));
  out.lines.emplace_back(0, 2);
  return out;
}
/// i / rate, rounded to so many seconds.
std::vector<double> times(std::size_t count, double rate_Hz, double digit_s = 0) {
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / rate_Hz;
    out.push_back(digit_s > 0 ? std::round(t / digit_s) * digit_s : t);
  }
  return out;
}
std::string wrong(std::vector<double> t, std::optional<double> rate_Hz = {}) {
  return rosin::rate_of(timed(std::move(t)), "a.csv", {rate_Hz, 0}).error();
}

}  // namespace

TEST_CASE("the rate: as told, or of a column of times however it is rounded") {
  CHECK(*rosin::rate_of(timed({0, 1}), "a.csv", {48000.0, {}}) == 48000);
  CHECK(rosin::rate_of(timed({0, 1}), "a.csv", {}).error().starts_with("a.csv: a table does not tell its rate"));
  for (const double digit : {0.0, 1e-7, 1e-6, 1e-5, 1e-4}) {
    CAPTURE(digit);
    const auto rate = rosin::rate_of(timed(times(20000, 50000, digit)), "a.csv", {{}, 0});
    CHECK(rate.error() == "");
    REQUIRE(rate);
    CHECK(std::abs(*rate / 50000 - 1) < 3e-4);
  }
  CHECK(*rosin::rate_of(timed(times(20000, 44100, 1e-6)), "a.csv", {{}, 0}) == 44100);
  CHECK(std::abs(*rosin::rate_of(timed(times(20000, 32768.5)), "a.csv", {{}, 0}) - 32768.5) < 1e-3);
}

TEST_CASE("gaps, doubled rows, times that go back and a rate that contradicts are told by line") {
  auto t = times(1000, 1000);
  for (std::size_t i = 500; i < t.size(); ++i) t[i] += 0.007;
  CHECK(wrong(t) == "a.csv:502: column 1 (t): the time jumps by 0.008 s where a step is 0.001 s: 7 row(s) are missing");
  t = times(1000, 1000);
  t[20] = t[19];
  CHECK(wrong(t).starts_with("a.csv:22: column 1 (t): the time moves by 0 s"));
  t = times(1000, 1000);
  t[700] = 0.2;
  CHECK(wrong(t).starts_with("a.csv:702: column 1 (t): the time goes back by 0.499 s"));
  CHECK(wrong(times(1000, 1000), 960.0).find("but rate_Hz is 960") != std::string::npos);
  CHECK(wrong(times(1000, 1000), 1000.0) == "");
  CHECK(wrong({3, 2, 1, 0}) == "a.csv: column 1 (t): does not rise: this is no column of times");
  CHECK(wrong({0, 1}) == "a.csv: column 1 (t): three times at least are needed to tell the rate");
  CHECK(rosin::rate_of(timed({0, 1, 2}), "a.csv", {{}, 7}).error() == "a.csv: has 2 column(s), but files.time_column is 7");
}

TEST_CASE("a recording has the columns as channels; a format that this build does not read is named") {
  const test::temporary_folder folder;
  const auto read =
      rosin::read_table_recording(folder.write("a.TSV", "f\tg\n1\t2\n3\t40\n"), {1000.0, {}}, rosin::plain_table_formats());
  CHECK(read.error() == "");
  REQUIRE(read);
  CHECK(read->columns == std::vector<std::string>{"f", "g"});
  CHECK(read->channels[1] == std::vector<double>{2, 40});
  CHECK(read->is_table);
  CHECK(read->sample_rate_Hz == 1000);
  CHECK(rosin::read_table("a.h5", rosin::plain_table_formats()).error() ==
        "a.h5: this build reads no .h5 files: the library for them was not found");
}

}  // namespace adapt_table_recording
