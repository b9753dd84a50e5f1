// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include <gtest/gtest.h>

namespace convexcut::test {

// in_child() with a network of its own: no interface but a `lo` that is down.
void in_network_namespace(const std::function<void()>& body);

// Runs `ip ARGUMENTS` and fails the test when it fails.
void ip(const std::string& arguments);

// Sets /proc/sys/net/ipv4/conf/INTERFACE/KEY.
void set_ipv4(const std::string& interface, const std::string& key, int value);

}  // namespace convexcut::test
