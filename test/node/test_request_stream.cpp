#include <gtest/gtest.h>
#include <spherical_springs/AddSprings.h>
#include <spherical_springs/SetParticles.h>

#include <random>
#include <stdexcept>
#include <string>

#include "node/kinds.h"
#include "node/request_stream.h"

namespace spherical_springs {
namespace {

/// Three springs of each kind.
ros::SerializedMessage message() {
  AddSprings::Request request;
  forEachKindInMessages([&](auto kind) { kind.springs(request).resize(3); });
  request.oriented_angle_springs[2].stiffness = 5;
  // As it comes to a service, without the length before it.
  auto whole = ros::serialization::serializeMessage(request);
  return {whole.buf, whole.num_bytes};
}

AddSprings::Request read(ros::SerializedMessage bytes, std::size_t begin, std::size_t end,
                         const core::SceneLimits& limits = {}) {
  bytes.message_start = bytes.buf.get() + begin;
  bytes.num_bytes = end;
  return readRequest<AddSprings::Request>(bytes, limits);
}

constexpr std::size_t kLengthBytes = 4;  // before a message

TEST(RequestStream, ReadsWhatWasWritten) {
  const auto request = read(message(), kLengthBytes, message().num_bytes);
  ASSERT_EQ(request.oriented_angle_springs.size(), 3u);
  EXPECT_EQ(request.oriented_angle_springs[2].stiffness, 5);
}

TEST(RequestStream, RefusesWhatIsCutOffAnywhere) {
  for (std::size_t end = kLengthBytes; end < message().num_bytes; ++end) {
    EXPECT_THROW(read(message(), kLengthBytes, end), std::exception) << end;
  }
}

std::string reasonAgainst(std::size_t bytes) {
  try {
    read(message(), kLengthBytes, kLengthBytes + bytes);
  } catch (const std::invalid_argument& fault) {
    return fault.what();
  }
  return "taken";
}

TEST(RequestStream, SaysThatARequestEndsTooEarly) {
  const std::string rest =
      " fewer than spherical_springs/AddSpringsRequest needs; the client may have been built for "
      "another version of the package";
  EXPECT_EQ(reasonAgainst(0), "the request ended too early: its 0 bytes are" + rest);
  EXPECT_EQ(reasonAgainst(1), "the request ended too early: its 1 byte is" + rest);
  EXPECT_EQ(reasonAgainst(10),
            "springs in the request are 3; allowed here: at most 0, as many as its bytes can hold");
}

TEST(RequestStream, RefusesMoreThanTheLimits) {
  core::SceneLimits limits;
  limits.springs = 2;
  EXPECT_THROW(read(message(), kLengthBytes, message().num_bytes, limits), std::invalid_argument);
}

TEST(RequestStream, TakesNamesOfFieldsWhateverTheLimits) {
  core::SceneLimits limits;
  limits.particles = limits.springs = 0;
  SetParticles::Request request;
  request.fields = {"position", "mass"};
  const auto bytes = ros::serialization::serializeMessage(request);
  ros::SerializedMessage whole(bytes.buf, bytes.num_bytes);
  whole.message_start = bytes.message_start;
  EXPECT_EQ(readRequest<SetParticles::Request>(whole, limits).fields, request.fields);
}

TEST(RequestStream, TakesNoMoreItemsThanBytesWhateverComes) {
  std::mt19937 generator(1);
  const auto bytes = message();
  int read_whole = 0;
  for (int i = 0; i < 20000; ++i) {
    for (std::size_t j = kLengthBytes; j < bytes.num_bytes; ++j) {
      bytes.buf[j] = generator() % 8 == 0 ? generator() % 256 : 0;
    }
    try {
      const auto request = read(bytes, kLengthBytes, bytes.num_bytes);
      ++read_whole;
      EXPECT_LE(springCount(request), bytes.num_bytes / 33);
    } catch (const std::exception&) {
      // Refused.
    }
  }
  EXPECT_GT(read_whole, 0);
  EXPECT_LT(read_whole, 20000);
}

}  // namespace
}  // namespace spherical_springs
