// SPDX-License-Identifier: Apache-2.0
#include "daemon/dds/cyclone_log.hpp"

#include <string_view>

#include <dds/ddsrt/log.h>

#include "daemon/log/log.hpp"

namespace convexcut::daemon {
namespace {

thread_local std::string* captured = nullptr;

std::string_view message_of(const dds_log_data_t& data) {
  std::string_view message(data.message, data.size);
  while (message.ends_with('\n')) message.remove_suffix(1);
  return message;
}

// On whichever thread of Cyclone has something to say.
void on_message(void*, const dds_log_data_t* data) {
  const std::string_view message = message_of(*data);
  const bool is_error = (data->priority & (DDS_LC_FATAL | DDS_LC_ERROR)) != 0;
  if (is_error && captured != nullptr) {
    if (captured->empty()) *captured = message;
  } else if (is_error) {
    log::error("cyclone_dds", {{"message", message}});
  } else if ((data->priority & DDS_LC_WARNING) != 0) {
    log::warning("cyclone_dds", {{"message", message}});
  } else {
    log::debug("cyclone_dds", {{"message", message}});
  }
}

}  // namespace

void route_cyclone_log() { dds_set_log_sink(on_message, nullptr); }

CycloneLogCapture::CycloneLogCapture() noexcept { captured = &first_; }
CycloneLogCapture::~CycloneLogCapture() { captured = nullptr; }

}  // namespace convexcut::daemon
