// SPDX-License-Identifier: MIT
//
// A program whose user interface has a decimal comma and groups of thousands, as GTK and Qt programs do from the environment: for C and
// for streams, as long as it stands. Where the machine has no such locale, one is made by localedef.
//
#pragma once

#include <support/temporary_folder.hpp>

#include <clocale>
#include <cstdlib>
#include <locale>

namespace test {

class comma_locale {
public:
  comma_locale() {
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"})
      found_ = found_ || std::setlocale(LC_ALL, name) != nullptr;
    if (!found_ && std::system(("localedef -i de_DE -f UTF-8 '" + (made_ / "de_DE.UTF-8") + "' >/dev/null 2>&1").c_str()) == 0) {
      ::setenv("LOCPATH", made_.str().c_str(), 1);
      found_ = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
      ::unsetenv("LOCPATH");
    }
    before_ = std::locale::global(std::locale{std::locale::classic(), new commas});
  }
  comma_locale(const comma_locale&) = delete;
  comma_locale& operator=(const comma_locale&) = delete;
  ~comma_locale() {
    std::locale::global(before_);
    std::setlocale(LC_ALL, "C");
  }
  /// C's functions write commas as well, not only streams.
  [[nodiscard]] bool for_c() const { return found_; }

private:
  struct commas : std::numpunct<char> {
    [[nodiscard]] char do_decimal_point() const override { return ','; }
    [[nodiscard]] char do_thousands_sep() const override { return '.'; }
    [[nodiscard]] std::string do_grouping() const override { return "\3"; }
  };
  bool found_ = false;
  temporary_folder made_;
  std::locale before_;
};

}  // namespace test
