// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <clocale>
#include <cmath>
#include <cstddef>
#include <locale>
#include <map>
#include <optional>
#include <random>

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "base/csv_table.hpp"
#include "base/number_text.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "test/support/temporary_folder.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

const fs::path CONFIG(HJT_TEST_CONFIG_DIR);

/// Numbers with a decimal comma, in the C library and in C++ streams, as long as it lives.
class CommaLocale
{
public:
  CommaLocale()
  {
    const fs::path script = CONFIG.parent_path() / "test/support/comma_locale.py";
    EXPECT_EQ(std::system((script.string() + ' ' + folder_.path().string()).c_str()), 0);
    setenv("LOCPATH", folder_.path().c_str(), 1);
    EXPECT_NE(std::setlocale(LC_NUMERIC, "comma"), nullptr);
    before_ = std::locale::global(std::locale(std::locale::classic(), new Comma));
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;
  ~CommaLocale()
  {
    std::locale::global(before_);
    std::setlocale(LC_NUMERIC, "C");
    unsetenv("LOCPATH");
  }

private:
  struct Comma : std::numpunct<char>
  {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };

  TemporaryFolder folder_;
  std::locale before_;
};

/// All that is read from the shipped files of joints, and how the parameters are written.
std::map<std::string, std::string> configurationTexts()
{
  std::map<std::string, std::string> texts;
  for (const auto& entry : fs::recursive_directory_iterator(CONFIG))
  {
    const fs::path folder = entry.path().parent_path().filename();
    if (entry.path().extension() == ".yaml" && folder != "arms" && folder != "signatures")
    {
      ParameterMap map;
      readDefaultConfiguration(CONFIG, map);
      readYamlFile(entry.path(), map);
      texts[entry.path()] = describeParameters(parseParameters(map));
    }
  }
  return texts;
}

/// Short numbers are read without the C library, which says what they are.
TEST(DecimalNumber, IsThatOfTheCLibrary)
{
  std::mt19937_64 random(5);
  const auto digits = [&random](std::size_t most)
  {
    std::string text;
    for (std::size_t left = random() % (most + 1); left > 0; --left)
    {
      text += static_cast<char>('0' + random() % 10);
    }
    return text;
  };
  for (int i = 0; i < 200000; ++i)
  {
    std::string text = (random() % 2 == 0 ? "-" : "") + digits(12) + "." + digits(12);
    text += random() % 2 == 0 ? "" : (random() % 2 == 0 ? "e-" : "E+") + std::to_string(random() % 40);
    const std::optional<double> number = decimalNumber(text);
    if (text.find_first_of("0123456789") < text.find_first_of("eE"))
    {
      ASSERT_TRUE(number) << text;
      EXPECT_EQ(*number, std::strtod(text.c_str(), nullptr)) << text;
      EXPECT_EQ(std::signbit(*number), text[0] == '-') << text;
    }
    else
    {
      EXPECT_FALSE(number) << text;
    }
  }
  for (const char* text : { "0", "-0", "1e400", "1e-400", "0e999999999999", "1e-999999999999", "9007199254740993",
                            "000000000000000000001", "123456789012345678901234567890" })
  {
    EXPECT_EQ(decimalNumber(text), std::strtod(text, nullptr)) << text;
  }
}

TEST(LocaleOfTheProgram, ChangesNoNumber)
{
  const auto plain = configurationTexts();
  const CommaLocale comma;
  EXPECT_EQ(std::strtod("0,5", nullptr), 0.5) << "the locale is in force";
  EXPECT_EQ(configurationTexts(), plain);
  EXPECT_EQ(decimalNumber("-1.25e-3"), -1.25e-3);
  EXPECT_EQ(numberText(31000.5), "31000.5");
  EXPECT_EQ(roundedText(0.125, 2), "0.12");
  EXPECT_EQ(fixedText(1234.5, 1), "1234.5");
  EXPECT_EQ(yamlNumber(YAML::Load("0.35")), 0.35);
  TextStream stream;
  stream << 1234 << ' ' << 0.5;
  EXPECT_EQ(stream.str(), "1234 0.5");
  TemporaryFolder folder;
  NumberTable<1> table(folder.write("table.csv", "time\n0.35\n"), { "time" });
  std::array<double, 1> row{};
  ASSERT_TRUE(table.read(row));
  EXPECT_EQ(row[0], 0.35);
}
}  // namespace
}  // namespace hjt
