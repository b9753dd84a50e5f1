// SPDX-License-Identifier: Apache-2.0
//
// Mesh files give their triangles, beside the scene that names them; those that are broken in any
// way are refused. Does not prove that every program's OBJ and PLY files can be read.
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "replay/simulation/scene/mesh.hpp"
#include "tests/replay/simulation/scene/scene_texts.hpp"

namespace convexcut::simulation {
namespace {

using test::errors_of;
using test::look;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class MeshFile : public ::testing::Test {
 protected:
  MeshFile()
      : directory_(std::filesystem::temp_directory_path() /
                   ("convexcut-mesh-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(directory_);
  }
  ~MeshFile() override { std::filesystem::remove_all(directory_); }

  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::ofstream(directory_ / name, std::ios::binary) << content;
    return directory_ / name;
  }

  std::filesystem::path directory_;
};

constexpr const char* kQuadObj =
    "# a square and a triangle\nmtllib x.mtl\nv 0 0 0\nv 1 0 0\r\nv 1 1 0 1.0\nv 0 1 0\nvn 0 0 1\n"
    "vt 0 0\nusemtl wood\nf 1/1/1 2/1/1 3//1 4\nv 0.5 0.5 1e0\nf -1 -5 -4\n";

std::string ply_header(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment made by hand\nelement vertex 5\n"
         "property float x\nproperty float y\nproperty double z\nproperty uchar red\n"
         "element face 2\nproperty list uchar int vertex_indices\nproperty short flag\n"
         "end_header\n";
}

std::string ascii_ply() {
  return ply_header("ascii") +
         "0 0 0 255\n1 0 0 255\n1 1 0 255\n0 1 0 255\n0.5 0.5 1 255\n4 0 1 2 3 -1\n3 4 0 1 -1\n";
}

template <class Value>
void put(std::string& bytes, Value value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string binary_ply() {
  std::string bytes = ply_header("binary_little_endian");
  const float xy[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5F, 0.5F}};
  for (int i = 0; i < 5; ++i) {
    put(bytes, xy[i][0]);
    put(bytes, xy[i][1]);
    put(bytes, i == 4 ? 1.0 : 0.0);
    put(bytes, std::uint8_t{255});
  }
  const std::vector<std::vector<std::int32_t>> faces{{0, 1, 2, 3}, {4, 0, 1}};
  for (const auto& face : faces) {
    put(bytes, static_cast<std::uint8_t>(face.size()));
    for (const std::int32_t index : face) put(bytes, index);
    put(bytes, std::int16_t{-1});
  }
  return bytes;
}

void expect_square_and_triangle(const Mesh& mesh) {
  ASSERT_EQ(mesh.vertices.size(), 5U);
  EXPECT_TRUE(mesh.vertices[4].isApprox(Vec3(0.5, 0.5, 1.0)));
  EXPECT_THAT(mesh.triangles, ElementsAre(Mesh::Triangle{0, 1, 2}, Mesh::Triangle{0, 2, 3},
                                          Mesh::Triangle{4, 0, 1}));
}

TEST_F(MeshFile, ObjAndBothKindsOfPlyGiveTheSame) {
  expect_square_and_triangle(read_mesh(write("a.obj", kQuadObj)));
  expect_square_and_triangle(read_mesh(write("a.ply", ascii_ply())));
  expect_square_and_triangle(read_mesh(write("b.PLY", binary_ply())));
}

TEST_F(MeshFile, IsFoundBesideTheSceneAndPlaced) {
  write("chair.ply", binary_ply());
  const auto file = write("room.toml", R"([rig]
position = [0, 0, 0]
[[mesh]]
name = "chair"
file = "chair.ply"
position = [2, 0, 0]
yaw_deg = 90
scale = 2
)");
  const Scene scene = Scene::load(file);
  EXPECT_EQ(scene.name(), "room");
  // The square is now at x = 0 … 2, y = 0 … 2.
  EXPECT_NEAR(look(scene, {0.5, 1.9, 5}, -Vec3::UnitZ()).distance_m, 5.0, 1e-12);
  EXPECT_EQ(look(scene, {2.5, 1, 5}, -Vec3::UnitZ()).surface, "nothing");
  EXPECT_THAT(errors_of("[[mesh]]\nfile = \"none.ply\"\n"),
              ElementsAre(HasSubstr("test.toml:2: mesh.file: none.ply: cannot open")));
  EXPECT_THAT(errors_of("[[mesh]]\nfile = \"chair.stl\"\n"),
              ElementsAre(HasSubstr("expected a file named .obj or .ply")));
  EXPECT_THAT(errors_of("[[mesh]]\nvertices = [[0,0,0],[1,0,0],[0,1,0]]\nfaces = [[0, 1, 3]]\n"),
              ElementsAre(HasSubstr("each 0 … 2, found [ 0, 1, 3 ]")));
}

std::string mesh_error(Mesh (*read)(std::string_view, std::string_view), std::string_view content) {
  try {
    static_cast<void>(read(content, "m"));
  } catch (const MeshError& error) {
    return error.what();
  }
  return "no error";
}

TEST(MeshReader, RefusesBrokenObj) {
  EXPECT_EQ(mesh_error(read_obj, "v 1 2\n"), "m:1: expected three numbers after v");
  EXPECT_EQ(mesh_error(read_obj, "v 1 2 x\n"), "m:1: expected three numbers after v");
  EXPECT_EQ(mesh_error(read_obj, "v 1 2 nan\n"), "m:1: expected three numbers after v");
  EXPECT_EQ(mesh_error(read_obj, "v 1 2 1e300\n"), "m:1: expected three numbers after v");
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const char* no_vertex = "m:4: expected numbers of vertices above this line after f";
  for (const char* face : {"f 1 2 4\n", "f 0 1 2\n", "f 1 2 -4\n", "f 1 2 x\n", "f 1 2 /3\n",
                           "f 99999999999999999999 1 2\n"}) {
    EXPECT_EQ(mesh_error(read_obj, three + face), no_vertex);
  }
  EXPECT_EQ(mesh_error(read_obj, three + "f 1 2\n"),
            "m:4: expected at least three vertices after f");
  EXPECT_THAT(mesh_error(read_obj, three), HasSubstr("m: no faces"));
  EXPECT_THAT(mesh_error(read_obj, ""), HasSubstr("m: no faces"));
}

TEST(MeshReader, RefusesBrokenPly) {
  const auto with = [](std::string from, const std::string& what, const std::string& by) {
    from.replace(from.find(what), what.size(), by);
    return from;
  };
  const std::string good = ascii_ply();
  EXPECT_EQ(mesh_error(read_ply, good), "no error");
  EXPECT_EQ(mesh_error(read_ply, "solid"), "m:1: expected \"ply\"");
  EXPECT_THAT(mesh_error(read_ply, with(good, "ascii", "binary_big_endian")),
              HasSubstr("m:2: expected format ascii or binary_little_endian"));
  EXPECT_THAT(mesh_error(read_ply, with(good, "vertex 5", "vertex 4000000000")),
              HasSubstr("m:4: expected an element's name and a count that the file can hold"));
  EXPECT_THAT(mesh_error(read_ply, with(good, "vertex 5", "vertex -5")), HasSubstr("m:4:"));
  EXPECT_THAT(mesh_error(read_ply, with(good, "float x", "single x")), HasSubstr("m:5:"));
  EXPECT_THAT(mesh_error(read_ply, with(good, "list uchar", "list float")), HasSubstr("m:10:"));
  EXPECT_THAT(mesh_error(read_ply, with(good, "end_header", "end_head")), HasSubstr("m:12:"));
  EXPECT_THAT(mesh_error(read_ply, with(good, "property double z\n", "")), HasSubstr("m: "));
  EXPECT_THAT(mesh_error(read_ply, with(good, "3 4 0 1", "3 5 0 1")),
              HasSubstr("a face of vertices that do not exist"));
  EXPECT_THAT(mesh_error(read_ply, with(good, "3 4 0 1", "3 -1 0 1")),
              HasSubstr("a face of vertices that do not exist"));
  EXPECT_THAT(mesh_error(read_ply, with(good, "3 4 0 1", "999999999 4 0 1")),
              HasSubstr("a list that is longer than the file"));
  EXPECT_THAT(mesh_error(read_ply, with(good, "0.5 0.5", "0.5 inf")),
              HasSubstr("expected x, y and z of each vertex"));
}

TEST(MeshReader, EveryTruncationOfAPlyIsRefused) {
  for (const std::string& whole : {ascii_ply(), binary_ply()}) {
    // The last characters of the text are a property that is read as a shorter number, and blanks.
    for (std::size_t length = 0; length + 2 < whole.size(); ++length) {
      const std::string error = mesh_error(read_ply, std::string_view(whole).substr(0, length));
      ASSERT_NE(error, "no error") << length;
    }
  }
}

TEST(MeshReader, AnyByteOfABinaryPlyMayBeWrong) {
  const std::string whole = binary_ply();
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (const unsigned flip : {0x01U, 0x80U, 0xFFU}) {
      std::string broken = whole;
      broken[i] = static_cast<char>(static_cast<unsigned char>(broken[i]) ^ flip);
      try {
        const Mesh mesh = read_ply(broken, "m");
        for (const Mesh::Triangle& triangle : mesh.triangles) {
          for (const std::uint32_t vertex : triangle) ASSERT_LT(vertex, mesh.vertices.size());
        }
      } catch (const MeshError& error) {
        ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      }
    }
  }
}

}  // namespace
}  // namespace convexcut::simulation
