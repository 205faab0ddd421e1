// SPDX-License-Identifier: MIT
#include <rosin/hardware/line_witness.hpp>

#include <doctest/doctest.h>

namespace {

std::string told(const std::string& bytes) {
  rosin::line_witness who;
  who.push({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  return who.in_words();
}

}  // namespace

TEST_CASE("nothing, a digitiser, a controller, another device, another speed") {
  CHECK(told("") == "nothing comes");
  rosin::packet_encoder<512> encoder{{.stream = 1, .channels = 2, .bits = 24, .rate_mHz = 128000000}};
  const std::array<std::int32_t, 128> samples{};
  std::string packets(1, '\0');
  for (int i = 0; i < 4; ++i) packets.append(reinterpret_cast<const char*>(encoder.data()), encoder.encode(samples.data(), 64));
  CHECK(told(packets).find("as from a digitiser") != std::string::npos);
  CHECK(told("[MSG:boot]\r\nGrbl 3.6 [FluidNC v3.6.8 (wifi) '$' for help]\r\n").find("a G-code controller talks (Grbl 3.6") !=
        std::string::npos);
  CHECK(told("<Idle|WPos:0,0,0>\r\n").find("a G-code controller talks (<Idle|WPos") != std::string::npos);
  CHECK(told("$GPGGA,123519,4807.038,N\r\n") == "something else talks ($GPGGA,123519,4807.038,N)");
  CHECK(told("\x81\x92\xfe\x01\x81\x92").find("the speed of the line") != std::string::npos);
}
