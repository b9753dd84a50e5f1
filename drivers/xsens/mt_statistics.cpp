// SPDX-License-Identifier: Apache-2.0
#include "drivers/xsens/mt_statistics.hpp"

#include <algorithm>
#include <array>
#include <chrono>

#include "drivers/xsens/mtdata2.hpp"
#include "drivers/xsens/sample_time.hpp"

namespace convexcut::xsens {
namespace {

std::string to_hex(wire::Bytes bytes) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string text;
  for (const std::byte b : bytes) {
    const auto value = static_cast<std::uint8_t>(b);
    text += kDigits[value >> 4U];
    text += kDigits[value & 0xFU];
  }
  return text;
}

// Printable characters only, and no blanks at the end: the device pads with them.
std::string to_text(wire::Bytes bytes) {
  std::string text;
  for (const std::byte b : bytes) {
    const char c = static_cast<char>(b);
    if (c >= ' ' && c <= '~') text += c;
  }
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

void add_once(std::vector<std::string>& list, std::string text) {
  if (std::find(list.begin(), list.end(), text) == list.end()) list.push_back(std::move(text));
}

}  // namespace

std::optional<double> MtStatistics::DataItem::rate_hz() const {
  const std::chrono::duration<double> span = latest - earliest;
  if (timed < 2 || span.count() <= 0) return std::nullopt;
  return static_cast<double>(timed - 1) / span.count();
}

void MtStatistics::on_bytes(wire::Bytes bytes) {
  framer_.feed(bytes, [this](const XbusFrame& frame) { on_frame(frame); });
}

void MtStatistics::on_frame(const XbusFrame& frame) {
  ++messages_[frame.message_id];
  switch (static_cast<MessageId>(frame.message_id)) {
    case MessageId::mtdata2:
      return on_data(frame.payload);
    case MessageId::device_id:
      return add_once(device_ids_, to_hex(frame.payload));
    case MessageId::product_code:
      return add_once(product_codes_, to_text(frame.payload));
    default:
      return;
  }
}

void MtStatistics::on_data(wire::Bytes payload) {
  MtMeasurement m;
  if (parse_mtdata2(payload, m) != PayloadStatus::ok) {
    ++malformed_payloads_;
    return;
  }
  std::optional<ImuTime> time;
  if (const auto ticks = sample_time_ticks(m)) time = clock_.unwrap(*ticks);
  const auto count = [&](const RawItem& raw) {
    DataItem& item = items_[raw.data_id];
    const auto size = static_cast<std::uint8_t>(raw.data.size());
    ++item.count;
    item.smallest = std::min(item.smallest, size);
    item.largest = std::max(item.largest, size);
    if (!time) return;
    // GNSS messages are older than their neighbours: the first is not always the earliest.
    item.earliest = item.timed == 0 ? *time : std::min(item.earliest, *time);
    item.latest = item.timed == 0 ? *time : std::max(item.latest, *time);
    ++item.timed;
  };
  static_cast<void>(for_each_item(payload, count));  // parse_mtdata2 has walked it to the end
}

}  // namespace convexcut::xsens
