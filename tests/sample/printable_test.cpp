#include "support/printable.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

namespace alcove::sample {
namespace {

TEST(Printable, ValidUtf8TextIsUnchanged) {
  for (const std::string text :
       {"", "hall.glb", "caf\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\x98\x80", "\xed\x9f\xbf"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, ControlCharactersBecomeSpaces) {
  EXPECT_EQ(printable(std::string("a\nb\x1b[31m\x7f\0c", 11)), "a b [31m  c");
}

TEST(Printable, InvalidUtf8IsReplaced) {
  const std::string stand_in = "\xef\xbf\xbd";
  EXPECT_EQ(printable("caf\xe9.gltf"), "caf" + stand_in + ".gltf");
  EXPECT_EQ(printable("\xe2\x82"), stand_in);                            // cut short
  EXPECT_EQ(printable("\xc0\xaf"), stand_in + stand_in);                 // overlong form
  EXPECT_EQ(printable("\xed\xa0\x80"), stand_in + stand_in + stand_in);  // half of a surrogate pair
  EXPECT_EQ(printable("\xf4\x90\x80\x80").size(), 4 * stand_in.size());  // above U+10FFFF
}

TEST(Printable, AnyBytesMadePrintableCanBeWrittenAsJson) {
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    std::string bytes(random() % 6, '\0');
    // Most bytes are 0x80 or above, which only multi-byte characters contain.
    for (char& byte : bytes)
      byte = static_cast<char>(random() % 8 == 0 ? random() : random() | 128);
    const std::string text = printable(bytes);
    EXPECT_EQ(nlohmann::json::parse(nlohmann::json(text).dump()).get<std::string>(), text);
  }
}

TEST(Printable, ShortenedTextKeepsItsBeginningAndItsEnd) {
  EXPECT_EQ(shortened("short", 16), "short");
  EXPECT_EQ(shortened("a\x1b[31mb", 16), "a [31mb");
  const std::string sentence = "cannot read " + std::string(5000, 'x') + ": it is damaged";
  const std::string cut = shortened(sentence, 100);
  EXPECT_EQ(cut.size(), 100u);
  EXPECT_TRUE(cut.starts_with("cannot read xxx"));
  EXPECT_TRUE(cut.ends_with("xxx: it is damaged"));
}

TEST(Printable, ShortenedTextIsNotCutWithinACharacter) {
  std::string text;
  for (int i = 0; i < 100; ++i) text += "\xc3\xa9";
  for (size_t most = 16; most < 40; ++most) {
    const std::string cut = shortened(text, most);
    EXPECT_LE(cut.size(), most);
    EXPECT_EQ(printable(cut), cut);
  }
}

}  // namespace
}  // namespace alcove::sample
