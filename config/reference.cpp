// SPDX-License-Identifier: Apache-2.0
#include "config/reference.hpp"

#include <string_view>

#include "config/schema.hpp"
#include "config/value_text.hpp"

namespace convexcut::config {
namespace {

constexpr std::string_view kFileHead =
    "# convexcut: every key with its default. Keys that are left out keep it; --set "
    "section.key=value\n"
    "# goes before this file. docs/configuration.md explains the errors.\n";

constexpr std::string_view kReferenceHead = R"(# Configuration

<!-- Written by convexcut-config-reference; edit config/key_table.cpp instead. -->

Every program takes `--config FILE`, a [TOML](https://toml.io) file, and any number of
`--set section.key=value`, which go before the file; of two for the same key the last one counts. Keys
that are left out keep their defaults: [config/convexcut.toml](../config/convexcut.toml) is a file of
all of them.

```toml
[lidar]
min_range_m = 0.8

[convex_cut]
planes = 720
```

    convexcut process --config robot.toml --set convex_cut.planes=180 --lidar drive.pcap --out scans

An integer is taken where a number is asked for, not the other way round. Identifiers may be written in
hexadecimal (`0x21`). In `--set`, texts need no quotes.

## When something is wrong

A program does not start on a wrong configuration. It exits with status 2 and lists everything that is
wrong, one line each: the place, the key, what was expected and what was found.

    robot.toml:2: lidar.min_range_m: expected a number 0 … 200, found "near"
    robot.toml:5: convex_cut.plane: unknown key; did you mean convex_cut.planes?
    --set worker.latency_ms=200: expected worker.latency_ms < worker.period_ms, found 200 and 100

Some values must suit each other:

* `lidar.min_range_m` is less than `lidar.max_range_m`, and `worker.latency_ms` less than
  `worker.period_ms`;
* the two ports of the lidar differ, and neither is one that DDS uses in `dds.domain`
  (7400 + 250 · domain and the following ones, for up to 33 participants);
* the CAN identifiers differ, and are at most `0x7ff` without `can.extended_ids`;
* the topics differ, and so do the frames.
)";

std::string value_of(const Key& key) {
  return concat(expected(key.domain), key.unit.empty() ? "" : " ", key.unit);
}

std::string default_of(const Key& key) { return to_toml(key.get(Config{}), key.domain); }

std::string toml_entry(const Key& key, const Config& config) {
  return concat("# ", key.description, "\n# ", value_of(key), "; default ", default_of(key), "\n",
                key.leaf(), " = ", to_toml(key.get(config), key.domain), "\n");
}

std::string markdown_row(const Key& key) {
  return concat("| `", key.leaf(), "` | ", value_of(key), " | `", default_of(key), "` | ",
                key.description, " |\n");
}

}  // namespace

std::string to_toml(const Config& config) {
  std::string text(kFileHead);
  for (const Section& section : sections()) {
    text += concat("\n# ", section.description, "\n[", section.name, "]\n");
    bool first = true;
    for (const Key& key : keys()) {
      if (key.section() != section.name) continue;
      if (!first) text += "\n";
      first = false;
      text += toml_entry(key, config);
    }
  }
  return text;
}

std::string reference_markdown() {
  std::string text(kReferenceHead);
  for (const Section& section : sections()) {
    text += concat("\n## `[", section.name, "]`\n\n", section.description,
                   "\n\n| key | value | default | meaning |\n|---|---|---|---|\n");
    for (const Key& key : keys()) {
      if (key.section() == section.name) text += markdown_row(key);
    }
  }
  return text;
}

}  // namespace convexcut::config
