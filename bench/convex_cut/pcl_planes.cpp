// SPDX-License-Identifier: Apache-2.0
#include "bench/convex_cut/pcl_planes.hpp"

#include <cstddef>
#include <memory>

#include <pcl/ModelCoefficients.h>
#include <pcl/PointIndices.h>
#include <pcl/filters/extract_indices.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/sac_segmentation.h>

namespace convexcut::bench {
namespace {

using PclCloud = pcl::PointCloud<pcl::PointXYZ>;

constexpr double kInlierDistanceM = 0.05;
constexpr int kIterations = 100;
constexpr std::size_t kMostPlanes = 10;
constexpr std::size_t kLeftShare = 10;  // a tenth

void find_planes(const PclCloud::ConstPtr& cloud) {
  pcl::SACSegmentation<pcl::PointXYZ> segmentation;
  segmentation.setModelType(pcl::SACMODEL_PLANE);
  segmentation.setMethodType(pcl::SAC_RANSAC);
  segmentation.setOptimizeCoefficients(true);
  segmentation.setMaxIterations(kIterations);
  segmentation.setDistanceThreshold(kInlierDistanceM);
  pcl::ExtractIndices<pcl::PointXYZ> extract;
  extract.setNegative(true);

  PclCloud::ConstPtr left = cloud;
  for (std::size_t i = 0; i < kMostPlanes && left->size() * kLeftShare > cloud->size(); ++i) {
    const auto inliers = std::make_shared<pcl::PointIndices>();
    pcl::ModelCoefficients plane;
    segmentation.setInputCloud(left);
    segmentation.segment(*inliers, plane);
    if (inliers->indices.empty()) return;
    const auto rest = std::make_shared<PclCloud>();
    extract.setInputCloud(left);
    extract.setIndices(inliers);
    extract.filter(*rest);
    left = rest;
  }
}

}  // namespace

std::optional<std::function<void()>> pcl_planes(const CloudView& cloud) {
  const auto copy = std::make_shared<PclCloud>();
  copy->reserve(cloud.x.size());
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    copy->emplace_back(cloud.x[i], cloud.y[i], cloud.z[i]);
  }
  return [copy] { find_planes(copy); };
}

}  // namespace convexcut::bench
