#include "surgeon_site/devices/register_reports.h"

#include <gtest/gtest.h>

#include "common/io/device/hid_port.h"
#include "tests/common/io/device/fake_hidapi.h"
#include "tests/common/io/device/fake_registers.h"

namespace palp::surgeon {
namespace {

using fake_hid::Bytes;
using io::PortFault;

class RegisterReportsTest : public testing::Test {
 protected:
  RegisterReportsTest() {
    fake_hid::Device made;
    made.path = "pedal";
    made.vendor = 7;
    made.product = 8;
    pedal = &fake_hid::plug(made);
    auto owned = std::make_unique<FakeRegisters>();
    registers = owned.get();
    port = std::make_unique<RegisterReports>(
        std::move(owned),
        std::make_unique<io::HidPort>(io::HidAddress{
            .vendor = 7, .product = 8, .interface_number = -1, .usage_page = 0, .serial = {}}));
  }
  ~RegisterReportsTest() override {
    port.reset();
    fake_hid::clear();
  }
  Bytes next() {
    Bytes report(RegisterReports::kBytesMax);
    std::size_t length = 0;
    fault = port->read(report, length, Duration{0});
    report.resize(length);
    return report;
  }

  fake_hid::Device* pedal{};
  FakeRegisters* registers{};
  std::unique_ptr<RegisterReports> port;
  PortFault fault{};
};

TEST_F(RegisterReportsTest, ARequestIsAReportAndSoIsItsAnswer) {
  ASSERT_EQ(port->open(), PortFault::None);
  registers->words[342] = 0x3039;
  EXPECT_EQ(port->write(fake_hid::bytes_of("01 00 03 00 02")), PortFault::None);
  EXPECT_EQ(registers->words[3], 2);
  EXPECT_TRUE(next().empty()) << "a write has no answer";
  EXPECT_EQ(port->write(fake_hid::bytes_of("03 00 1C 01 56 00 02 01 F4 00 00")), PortFault::None);
  EXPECT_EQ(registers->words[28], 500);
  EXPECT_EQ(port->write(fake_hid::bytes_of("02 00 03 00 01")), PortFault::None);
  EXPECT_EQ(next(), fake_hid::bytes_of("03 01 56 30 39 00 00"));
  EXPECT_EQ(next(), fake_hid::bytes_of("02 00 03 00 02"));
  EXPECT_TRUE(next().empty());
}

TEST_F(RegisterReportsTest, ThePedalsReportsComeInBetween) {
  ASSERT_EQ(port->open(), PortFault::None);
  pedal->input.push_back({0, 1});
  EXPECT_EQ(next(), fake_hid::bytes_of("04 00 01"));
  pedal->there = false;
  EXPECT_TRUE(next().empty());
  EXPECT_EQ(fault, PortFault::PedalLost) << "nobody knows whether it is held";
}

TEST_F(RegisterReportsTest, WithoutItsPedalItIsNotOpened) {
  pedal->there = false;
  EXPECT_EQ(port->open(), PortFault::PedalNotOpen);
  pedal->there = true;
  registers->openable = false;
  EXPECT_EQ(port->open(), PortFault::NotOpen);
}

TEST_F(RegisterReportsTest, ALostLineIsToldByTheNextLook) {
  ASSERT_EQ(port->open(), PortFault::None);
  registers->fault = PortFault::Lost;
  EXPECT_EQ(port->write(fake_hid::bytes_of("02 00 03 00 01")), PortFault::Lost);
  (void)next();
  EXPECT_EQ(fault, PortFault::Lost);
  registers->fault = PortFault::None;
  ASSERT_EQ(port->open(), PortFault::None);
  (void)next();
  EXPECT_EQ(fault, PortFault::None);
}

TEST_F(RegisterReportsTest, WhatIsNoRequestIsRefused) {
  ASSERT_EQ(port->open(), PortFault::None);
  for (const char* bytes :
       {"", "01", "01 00 03 00", "02 00 03 00 11", "09 00 03 00 01", "03 00 1C 01 56 00 02"}) {
    EXPECT_EQ(port->write(fake_hid::bytes_of(bytes)), PortFault::Refused) << bytes;
  }
  EXPECT_EQ(port->set_feature(fake_hid::bytes_of("01 00")), PortFault::Refused);
}

}  // namespace
}  // namespace palp::surgeon
