// SPDX-License-Identifier: Apache-2.0
//
// A result of `convexcut process` beside the truth of the simulated recording that it was made of.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "core/scan/function_ref.hpp"
#include "core/time.hpp"
#include "replay/evaluation/result_reader.hpp"
#include "replay/evaluation/scan_figures.hpp"
#include "replay/evaluation/truth_matching.hpp"
#include "replay/simulation/truth/truth_reader.hpp"

namespace convexcut::evaluation {

struct EvaluateOptions {
  std::filesystem::path truth;   // the folder `truth`, or the one that has it
  std::filesystem::path result;  // what `convexcut process --out` wrote
  // Scans with less of a revolution (the first and the last of a recording) are left out.
  double least_coverage = 0.9;
};

struct EvaluatedScan {
  ResultScan scan;
  ScanFigures figures;
  std::size_t unmatched = 0;  // points whose truth was not found: in no count
  Duration offset{};          // of the result's clock from the truth's
};

struct Evaluation {
  simulation::TruthSettings settings;
  std::vector<EvaluatedScan> scans;
  Totals totals;                          // of these scans, in their order
  std::vector<SurfaceCounts> by_surface;  // by index into settings.surfaces
  std::size_t left_out = 0;               // scans that are not whole
  std::size_t unmatched = 0;
};

// A scan with the truth of its points, for pictures.
struct MatchedScan {
  replay::PcdCloud cloud;
  MatchedTruth truth;
};

class Evaluator {
 public:
  // Throws std::runtime_error (TruthError) of one line.
  explicit Evaluator(const EvaluateOptions& options);

  using Progress = FunctionRef<void(std::size_t done, std::size_t of_scans)>;
  // Throws std::runtime_error of one line: truth and result do not belong together, no whole scan,
  // a scan that cannot be read.
  [[nodiscard]] Evaluation run(Progress progress);

  // Any scan once more. Throws as run().
  void load(const ResultScan& scan, MatchedScan& out);

 private:
  void check_times() const;
  void check_surfaces(const MatchedTruth& truth) const;

  EvaluateOptions options_;
  simulation::TruthReader truth_;
  ResultReader result_;
  TruthMatcher matcher_;
  PatchJudge judge_;
};

}  // namespace convexcut::evaluation
