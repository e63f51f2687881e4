#include <gtest/gtest.h>

#include <string>

#include "spherical_springs/range.h"

namespace spherical_springs::core {
namespace {

TEST(TextsInMessages, AreQuotedWhole) {
  EXPECT_EQ(quoted(""), "''");
  EXPECT_EQ(quoted("leapfrog"), "'leapfrog'");
  EXPECT_EQ(quoted(std::string(100, 'x')), "'" + std::string(100, 'x') + "'");
}

TEST(TextsInMessages, AreShortenedWhereTheyAreLong) {
  const std::string text(5000, 'x');
  EXPECT_EQ(shortened(text), std::string(100, 'x') + "...");
  EXPECT_EQ(quoted(text), "'" + std::string(100, 'x') + "...' (5000 bytes)");
}

TEST(TextsInMessages, AreNotCutWithinACharacter) {
  const std::string head(98, 'x');
  EXPECT_EQ(shortened(head + "\u20ac" + "x"), head + "...");
  EXPECT_EQ(shortened("x" + head + "\u00e4"), "x" + head + "...");
  EXPECT_EQ(shortened(head + "\u00e4" + "x"), head + "\u00e4" + "...");
}

TEST(TextsInMessages, StayOnOneLine) {
  EXPECT_EQ(quoted(std::string("a\nb\0c\x7f", 6)), "'a?b?c?'");
}

}  // namespace
}  // namespace spherical_springs::core
