#include "core/base64.h"

#include <gtest/gtest.h>

#include <string_view>
#include <utility>
#include <vector>

namespace retrace::base64_test {
namespace {

/// Test vectors of RFC 4648, section 10.
TEST(Base64, IsThatOfTheStandard) {
  const std::vector<std::pair<std::string_view, std::string_view>> vectors = {
      {"", ""},
      {"f", "Zg=="},
      {"fo", "Zm8="},
      {"foo", "Zm9v"},
      {"foob", "Zm9vYg=="},
      {"fooba", "Zm9vYmE="},
      {"foobar", "Zm9vYmFy"},
      {std::string_view("\0\xff\xfe", 3), "AP/+"}};
  for (const auto& [bytes, text] : vectors) EXPECT_EQ(base64(bytes), text) << bytes;
}

}  // namespace
}  // namespace retrace::base64_test
