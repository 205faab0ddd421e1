// SPDX-License-Identifier: MIT
#include <rosin/adapt/riff_layout.hpp>

#include <doctest/doctest.h>

#include <sstream>

namespace {

std::string number(std::uint64_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(i < 8 ? value >> (8 * i) & 0xffU : 0U);
  return out;
}

std::string wav(std::uint64_t promised, std::size_t present, const std::string& extra = "", const std::string& form = "RIFF") {
  return form + number(4 + extra.size() + 24 + 8 + promised, 4) + "WAVE" + extra + "fmt " + number(16, 4) +
         std::string(16, '\1') + "data" + number(promised, 4) + std::string(present, '\0');
}

std::optional<rosin::riff_layout> layout(const std::string& bytes) {
  std::istringstream in{bytes};
  return rosin::read_riff_layout(in);
}

}  // namespace

TEST_CASE("promised and present samples") {
  const auto whole = layout(wav(100, 100));
  REQUIRE(whole);
  CHECK(whole->format.size() == 16);
  CHECK(whole->data_offset == 44);
  CHECK(whole->data_promised == 100);
  CHECK(whole->data_present() == 100);
  CHECK(layout(wav(100, 30))->data_present() == 30);
  CHECK(layout(wav(100, 0))->data_present() == 0);
}

TEST_CASE("chunks before the samples, of odd size too") {
  const auto found = layout(wav(10, 10, "LIST" + number(3, 4) + "abc" + std::string(1, '\0')));
  REQUIRE(found);
  CHECK(found->data_offset == 44 + 12);
  CHECK(found->data_promised == 10);
}

TEST_CASE("a stream of unknown length promises nothing") {
  CHECK_FALSE(layout(wav(0xffffffffU, 30))->data_promised);
  CHECK_FALSE(layout(wav(0, 30))->data_promised);
  CHECK(layout(wav(0, 0))->data_promised == 0);
}

TEST_CASE("sizes that writers of streams put there stand for none, where the file is shorter") {
  for (const std::uint64_t size : {0x7ffff000U, 0x7fffffffU, 0x80000000U, 0xfffff000U, 0xffffffffU}) {
    CAPTURE(size);
    CHECK_FALSE(layout(wav(size, 30))->data_promised);
  }
  CHECK(layout(wav(0x40000000U, 30))->data_promised == 0x40000000U);
}

TEST_CASE("the chunk after one that was told to hold no samples is no sample") {
  const auto found = layout(wav(0, 0) + "LIST" + number(4, 4) + "INFO");
  REQUIRE(found);
  CHECK(found->data_promised == 0);
}

TEST_CASE("samples of unknown number end where the whole is said to end") {
  std::string text = wav(0, 30);
  text.replace(4, 4, number(text.size() - 8, 4));
  CHECK(layout(text + "tail of another program")->data_present() == 30);
}

TEST_CASE("an odd chunk, with its pad or without") {
  for (const bool padded : {true, false}) {
    CAPTURE(padded);
    const auto found = layout(wav(10, 10, "bext" + number(3, 4) + "abc" + std::string(padded ? 1 : 0, '\0')));
    REQUIRE(found);
    CHECK(found->format.size() == 16);
    CHECK(found->data_promised == 10);
  }
}

TEST_CASE("a second chunk of samples, a format after the samples") {
  const auto two = layout(wav(10, 10) + "data" + number(4, 4) + "abcd");
  REQUIRE(two);
  CHECK(two->second_data == 54);
  const std::string late =
      "RIFF" + number(46, 4) + "WAVE" + "data" + number(4, 4) + "abcd" + "fmt " + number(16, 4) + std::string(16, '\1');
  CHECK(layout(late)->format.size() == 16);
  CHECK(layout(late)->data_offset == 20);
}

TEST_CASE("of a stream the beginning is enough") {
  std::istringstream in{wav(0, 0)};
  const auto found = rosin::read_riff_layout(in, rosin::riff_extent::beginning);
  REQUIRE(found);
  CHECK(found->data_offset == 44);
  CHECK_FALSE(found->data_promised);
}

TEST_CASE("RF64 and BW64 keep its sizes in ds64") {
  const std::string ds64 = "ds64" + number(28, 4) + number(999, 8) + number(5000000000, 8) + number(0, 12);
  const std::string nothing = "ds64" + number(28, 4) + number(0, 28);
  for (const char* form : {"RF64", "BW64"}) {
    const auto found = layout(wav(0xffffffffU, 30, ds64, form));
    REQUIRE(found);
    CHECK(found->data_promised == 5000000000);
    const auto untold = layout(wav(0xffffffffU, 30, nothing, form));
    REQUIRE(untold);
    CHECK_FALSE(untold->data_promised);
    CHECK(untold->data_present() == 30);
  }
}

TEST_CASE("what ends too early or is something else") {
  CHECK_FALSE(layout(""));
  CHECK_FALSE(layout("RIFF"));
  CHECK_FALSE(layout("fLaC and so on"));
  CHECK_FALSE(layout("RIFF" + number(4, 4) + "AVI "));
  const auto cut = layout(wav(100, 100).substr(0, 40));
  REQUIRE(cut);
  CHECK_FALSE(cut->data_offset);
  const auto endless = layout("RIFF" + number(4, 4) + "WAVE" + "junk" + number(0xfffffff0U, 4) + "x");
  REQUIRE(endless);
  CHECK_FALSE(endless->data_offset);
}
