// Sets a locale in which numbers have a decimal comma.
#pragma once

#include <clocale>
#include <locale>
#include <string>

namespace alcove::passes {

// During the object's lifetime, the C++ locale writes a comma as the decimal separator and points
// between groups of three digits. The C locale does so too if the system has such a locale. Many
// container images have none. Tests should therefore also print numbers of four or more digits,
// because the C++ locale always separates their groups.
class CommaLocale {
 public:
  CommaLocale() : c_before_(std::setlocale(LC_ALL, nullptr)) {
    for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "es_ES.UTF-8", "nl_NL.UTF-8"})
      if (std::setlocale(LC_ALL, name) != nullptr) break;
    before_ = std::locale::global(std::locale(std::locale(), new Numbers));
  }
  ~CommaLocale() {
    std::locale::global(before_);
    std::setlocale(LC_ALL, c_before_.c_str());
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;

 private:
  struct Numbers : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };

  std::string c_before_;
  std::locale before_;
};

}  // namespace alcove::passes
