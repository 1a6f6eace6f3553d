// Masses of meshes and shells in MJCF against solids and integrals that are known.

#include "equations/model_folder.h"

#include <momenta/core/format/mesh/mesh_mass.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>
#include <sstream>

namespace momenta::core_mjcf_meshes {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using reading::Mesh;
using reading::MeshMass;

class MjcfMeshes : public equations::ModelFolder {
 protected:
  /// The one body of a model with these assets and geoms.
  BodySpec body(const std::string& asset, const std::string& geom,
                const std::string& compiler = "") const {
    const Scene scene =
        mjcf("<compiler " + compiler + "/><asset>" + asset +
             "</asset><worldbody><body name='b'><joint/>" + geom + "</body></worldbody>");
    return scene.bodies.at(0);
  }
};

void expect_same(const BodySpec& a, const BodySpec& b, double slack) {
  EXPECT_NEAR(a.mass, b.mass, slack * b.mass);
  EXPECT_LE((a.com - b.com).norm(), slack * (1 + b.com.norm()));
  EXPECT_LE((a.inertia - b.inertia).norm(), slack * b.inertia.norm());
}

Mesh box(double a, double b, double c) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.points.emplace_back((i & 1) != 0 ? a : -a, (i & 2) != 0 ? b : -b, (i & 4) != 0 ? c : -c);
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// Rings of `around` points on a circle of radius r, `along` of them on a circle of radius R.
Mesh torus(double R, double r, int around, int along) {
  Mesh mesh;
  const double turn = 2 * std::numbers::pi;
  for (int i = 0; i < along; ++i)
    for (int k = 0; k < around; ++k) {
      const double u = turn * i / along, v = turn * k / around, x = R + r * std::cos(v);
      mesh.points.emplace_back(x * std::cos(u), x * std::sin(u), r * std::sin(v));
    }
  const auto at = [&](int i, int k) {
    return static_cast<std::uint32_t>((i % along) * around + k % around);
  };
  for (int i = 0; i < along; ++i)
    for (int k = 0; k < around; ++k) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  return mesh;
}

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}
void put(std::string& bytes, const Vector3d& p) {
  for (const double x : p) put(bytes, static_cast<float>(x));
}

std::string stl(const Mesh& mesh) {
  std::string bytes(80, 's');
  put(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    put(bytes, Vector3d(Vector3d::Zero()));
    for (const std::uint32_t i : t) put(bytes, mesh.points[i]);
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}
std::string stl_text(const Mesh& mesh) {
  std::ostringstream text;
  text.precision(17);
  text << "solid of a test\n";
  for (const auto& t : mesh.triangles) {
    text << "facet normal 0 0 0\n outer loop\n";
    for (const std::uint32_t i : t) text << "  vertex " << mesh.points[i].transpose() << "\n";
    text << " endloop\nendfacet\n";
  }
  text << "endsolid\n";
  return text.str();
}
std::string obj(const Mesh& mesh, bool backwards = false) {
  std::ostringstream text;
  text.precision(17);
  text << "# a test\nmtllib none.mtl\no solid\n";
  for (const Vector3d& p : mesh.points) text << "v " << p.transpose() << "\r\n";
  text << "vn 0 0 1\ns off\n";
  const auto count = static_cast<long>(mesh.points.size());
  for (const auto& t : mesh.triangles) {
    text << "f";
    for (const long i : t) text << " " << (backwards ? i - count : i + 1) << "//1 \\\n";
    text << "\n";
  }
  return text.str();
}
std::string msh(const Mesh& mesh) {
  std::string bytes;
  put(bytes, static_cast<std::int32_t>(mesh.points.size()));
  put(bytes, std::int32_t{1});
  put(bytes, std::int32_t{2});
  put(bytes, static_cast<std::int32_t>(mesh.triangles.size()));
  for (const Vector3d& p : mesh.points) put(bytes, p);
  put(bytes, Vector3d(1, 2, 3));
  bytes.append(16, '\1');
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t i : t) put(bytes, static_cast<std::int32_t>(i));
  return bytes;
}

// The mesh of a box is the box: in every format, by every way to weigh it, in any frame.
TEST_F(MjcfMeshes, BoxOfTrianglesIsABox) {
  const Mesh mesh = box(0.25, 0.5, 0.125);  // exact in float32
  write("assets/box.STL", stl(mesh));
  write("assets/text.stl", stl_text(mesh));
  write("assets/box.obj", obj(mesh));
  write("assets/back.obj", obj(mesh, true));
  write("assets/box.msh", msh(mesh));
  const std::string frame = " pos='1 2 3' euler='10 20 30'";
  for (const std::string weight : {"", " mass='3'", " density='70'"}) {
    const BodySpec solid = body("", "<geom type='box' size='.25 .5 .125'" + frame + weight + "/>");
    for (const char* file : {"box.STL", "text.stl", "box.obj", "back.obj", "box.msh"})
      for (const char* inertia : {"", "convex", "exact", "legacy"}) {
        SCOPED_TRACE(std::string(file) + " " + inertia + weight);
        const std::string way = *inertia != 0 ? " inertia='" + std::string(inertia) + "'" : "";
        expect_same(body("<mesh name='m' file='" + std::string(file) + "'" + way + "/>",
                         "<geom type='mesh' mesh='m'" + frame + weight + "/>", "meshdir='assets'"),
                    solid, 1e-14);
      }
    const BodySpec shell =
        body("", "<geom type='box' size='.25 .5 .125' shellinertia='true'" + frame + weight + "/>");
    for (const std::string way : {" inertia='shell'", ""})
      expect_same(body("<mesh file='some/where/box.STL'" + way + "/>",
                       "<geom type='mesh' mesh='box'" + frame + weight +
                           (way.empty() ? " shellinertia='true'/>" : "/>"),
                       "assetdir='assets' strippath='true'"),
                  shell, 1e-14);
  }
}

// scale · R(refquat)ᵀ (p − refpos), from a class; mirrored too.
TEST_F(MjcfMeshes, ScaleAndReferenceFrame) {
  Mesh mesh = box(0.5, 0.25, 1);
  const Vector3d at(3, -1, 2);
  const Eigen::Quaterniond turn = Eigen::Quaterniond(1, -2, 0.5, 0.25).normalized();
  for (Vector3d& p : mesh.points) p = turn * p + at;
  write("box.obj", obj(mesh));
  const BodySpec solid = body("", "<geom type='box' size='1 .125 3' pos='.1 .2 .3'/>");
  for (const char* scale : {"2 .5 3", "-2 .5 3", "-2 -.5 -3"})
    for (const char* inertia : {"convex", "exact", "legacy"}) {
      const Scene scene = mjcf(
          "<default><mesh scale='" + std::string(scale) + "' inertia='" + inertia +
          "'/></default><asset><mesh file='box.obj' refpos='3 -1 2' refquat='1 -2 .5 "
          ".25'/></asset><worldbody><body name='b'><joint/><geom type='mesh' mesh='box' pos='.1 "
          ".2 .3'/></body></worldbody>");
      expect_same(scene.bodies.at(0), solid, 1e-13);
    }
}

// Corners 0, a e1, b e2, c e3 and density ρ: m = ρ abc/6, com (a, b, c)/4, and about the corner at
// 0 moments m (b² + c²)/10 and products m ab/20. Written in the model; without faces it is the
// hull.
TEST_F(MjcfMeshes, Tetrahedron) {
  const double a = 0.3, b = 0.7, c = 1.1, m = 1000 * a * b * c / 6;
  const Vector3d com = Vector3d(a, b, c) / 4;
  Matrix3d expected;
  expected << b * b + c * c, -a * b / 2, -a * c / 2, -a * b / 2, a * a + c * c, -b * c / 2,
      -a * c / 2, -b * c / 2, a * a + b * b;
  expected *= m / 10;
  expected -= m * (com.squaredNorm() * Matrix3d::Identity() - com * com.transpose());
  for (const char* faces : {"' face='0 2 1 0 1 3 0 3 2 1 2 3", "", "' inertia='exact"}) {
    const BodySpec found =
        body("<mesh name='m' vertex='0 0 0 .3 0 0 0 .7 0 0 0 1.1" + std::string(faces) + "'/>",
             "<geom type='mesh' mesh='m'/>");
    EXPECT_NEAR(found.mass, m, 1e-14 * m);
    EXPECT_LE((found.com - com).norm(), 1e-15);
    EXPECT_LE((found.inertia - expected).norm(), 1e-14 * expected.norm());
  }
}

// A torus of 2n × n points comes near its integrals as 1/n², a hull near that of the torus, which
// is a body of revolution of radius R + √(r² − z²); pyramids count too much.
TEST_F(MjcfMeshes, TorusConverges) {
  const double R = 2, r = 0.5, pi = std::numbers::pi;
  const double volume = 2 * pi * pi * R * r * r, area = 4 * pi * pi * R * r;
  const double hull = 2 * pi * R * R * r + pi * pi * R * r * r + 4 * pi / 3 * r * r * r;
  const auto errors = [&](int n) {
    const Mesh mesh = torus(R, r, n, 2 * n);
    std::string fault;
    const MeshMass inside = reading::mass_of_inside(mesh, fault);
    const MeshMass shell = reading::mass_of_shell(mesh, fault);
    const MeshMass around = reading::mass_of_inside(reading::hull_of(mesh, fault), fault);
    EXPECT_EQ(fault, "");
    EXPECT_LE(inside.com.norm() + shell.com.norm(), 1e-14);
    EXPECT_GT(reading::mass_by_pyramids(mesh, fault).measure, 1.1 * volume);
    Eigen::Matrix<double, 7, 1> e;
    e << inside.measure / volume - 1, inside.inertia(2, 2) / (volume * (R * R + 0.75 * r * r)) - 1,
        inside.inertia(0, 0) / (volume * (R * R / 2 + 0.625 * r * r)) - 1, shell.measure / area - 1,
        shell.inertia(2, 2) / (area * (R * R + 1.5 * r * r)) - 1,
        shell.inertia(0, 0) / (area * (R * R / 2 + 1.25 * r * r)) - 1, around.measure / hull - 1;
    return e;
  };
  const Eigen::Matrix<double, 7, 1> coarse = errors(40), fine = errors(80);
  for (int i = 0; i < 7; ++i) {
    EXPECT_LT(std::abs(coarse[i]), 0.02) << i;
    EXPECT_NEAR(coarse[i] / fine[i], 4, 0.1) << i;
  }
}

// A prism over an L of three unit squares, seen whole from its middle: 3 m³, and 3.5 m³ in its
// hull.
TEST_F(MjcfMeshes, TheDefaultIsThatOfMujoco) {
  const auto mass = [&](const std::string& inertia) {
    return body(
               "<mesh name='m' vertex='0 0 0 2 0 0 2 1 0 1 1 0 1 2 0 0 2 0 0 0 1 2 0 1 2 1 1 1 1 "
               "1 1 2 1 0 2 1' face='0 3 1 1 3 2 0 4 3 0 5 4 6 7 9 7 8 9 6 9 10 6 10 11 0 1 7 0 7 "
               "6 1 2 8 1 8 7 2 3 9 2 9 8 3 4 10 3 10 9 4 5 11 4 11 10 5 0 6 5 6 11'" +
                   inertia + "/>",
               "<geom type='mesh' mesh='m' density='1000'/>")
        .mass;
  };
  EXPECT_NEAR(mass(""), 3000, 1e-9);
  EXPECT_NEAR(mass(" inertia='legacy'"), 3000, 1e-9);
  EXPECT_NEAR(mass(" inertia='exact'"), 3000, 1e-9);
  EXPECT_NEAR(mass(" inertia='convex'"), 3500, 1e-9);
  EXPECT_NEAR(mass(" inertia='shell'"), 14000, 1e-9);
}

// A solid with a deep dent: its own inside, its hull, and pyramids, which overlap; that is said.
TEST_F(MjcfMeshes, PyramidsThatOverlapAreSaid) {
  Mesh mesh = box(1, 1, 1);
  mesh.points.emplace_back(0, 0, -0.5);  // in place of the middle of the upper side
  mesh.triangles[2] = {4, 5, 8};
  mesh.triangles[3] = {5, 7, 8};
  mesh.triangles.push_back({7, 6, 8});
  mesh.triangles.push_back({6, 4, 8});
  write("dent.obj", obj(mesh));
  const std::string geom = "<geom type='mesh' mesh='dent' density='1'/>";
  const auto model = [&](const std::string& inertia, const std::string& compiler = "") {
    return mjcf("<compiler " + compiler + "/><asset><mesh file='dent.obj'" + inertia +
                "/></asset><worldbody><body><joint/>" + geom + "</body></worldbody>");
  };
  EXPECT_NEAR(model(" inertia='convex'").bodies[0].mass, 8, 1e-14);
  EXPECT_NEAR(model(" inertia='exact'").bodies[0].mass, 6, 1e-14);
  EXPECT_NEAR(model("", "exactmeshinertia='true'").bodies[0].mass, 6, 1e-14);
  EXPECT_GT(model("").bodies[0].mass, 6.1);
  const auto said = [](const Scene& scene) {
    int count = 0;
    for (const std::string& remark : scene.remarks)
      count += remark.starts_with("weighed by pyramids");
    return count;
  };
  EXPECT_EQ(said(model("")), 1);
  EXPECT_EQ(said(model(" inertia='exact'")), 0);
  EXPECT_EQ(said(model(" inertia='convex'")), 0);
}

// Shells of geoms: slices of the surface of a body of revolution, ρ(z) its radius.
TEST_F(MjcfMeshes, ShellsOfGeoms) {
  const auto expect_shell = [&](const std::string& geom, double height, double cap,
                                const std::function<double(double)>& radius) {
    constexpr int n = 200000;
    double area = 2 * std::numbers::pi * cap * cap, polar = area * cap * cap / 2,
           axial = area * height * height;
    for (int i = 0; i < n; ++i) {
      const double dz = 2 * height / n, z = -height + (i + 0.5) * dz;
      const double lower = radius(z - dz / 2), upper = radius(z + dz / 2);
      const double rho = (lower + upper) / 2;
      const double strip = 2 * std::numbers::pi * rho * std::hypot(dz, upper - lower);
      area += strip;
      polar += strip * rho * rho;
      axial += strip * z * z;
    }
    const BodySpec found = body("", "<geom shellinertia='true' density='2' " + geom + "/>");
    EXPECT_NEAR(found.mass, 2 * area, 1e-6 * found.mass);
    EXPECT_NEAR(found.inertia(2, 2), 2 * polar, 1e-6 * found.inertia(2, 2));
    EXPECT_NEAR(found.inertia(0, 0), polar + 2 * axial, 1e-6 * found.inertia(0, 0));
  };
  const auto arc = [](double r) {
    return [r](double z) { return std::sqrt(std::max(0., r * r - z * z)); };
  };
  expect_shell("size='.3'", .3, 0, arc(.3));
  expect_shell("type='cylinder' size='.3 .5'", .5, .3, [](double) { return .3; });
  expect_shell("type='capsule' size='.3 .5'", .8, 0,
               [&](double z) { return arc(.3)(std::max(0., std::abs(z) - .5)); });
}

// One sentence each, with the line of the <mesh> and, where it is read, the file.
TEST_F(MjcfMeshes, WrongMeshes) {
  const auto refused = [&](const std::string& asset, const std::string& expected,
                           const std::string& compiler = "") {
    expect_refused("<compiler " + compiler + "/><asset>\n" + asset +
                       "</asset><worldbody><body name='b'><joint/><geom type='mesh' "
                       "mesh='m'/></body></worldbody>",
                   "m.xml", expected);
  };
  const auto file = [&](const std::string& name, const std::string& bytes) {
    write(name, bytes);
    return "<mesh name='m' file='" + name + "' inertia='exact'/>";
  };
  const Mesh whole = box(1, 1, 1);
  Mesh mesh = whole;
  mesh.triangles.pop_back();
  refused(
      file("open.stl", stl(mesh)),
      ":2: mesh 'm': <mesh> file is 'open.stl', which is not closed at the edge between points ");
  mesh = whole;
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  refused(file("turned.obj", obj(mesh)), "which is not closed at the edge");
  mesh = whole;
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  refused(file("inside_out.obj", obj(mesh)), "which has a negative volume, expected corners that");
  mesh = whole;
  for (Vector3d& p : mesh.points) p[2] = 0;
  refused(file("flat.obj", obj(mesh)), "which has no volume, expected a solid");
  write("flat2.obj", obj(mesh));
  refused("<mesh name='m' file='flat2.obj' inertia='convex'/>", "has no convex hull with a volume");
  refused("<mesh name='m' file='flat2.obj'/>", "has no volume");
  std::string bytes = stl(whole);
  refused(file("short.stl", bytes.substr(0, 500)),
          ": mesh 'm': <mesh> file cannot be read: " + (folder / "short.stl").string() +
              ": has 500 bytes, expected 684 for the 12 triangles in its head");
  bytes[80] = bytes[81] = bytes[82] = bytes[83] = '\xff';
  refused(file("counts.stl", bytes), "expected 214748364834 for the 4294967295 triangles");
  bytes = stl(whole);
  const float nan = std::nanf("");
  std::memcpy(&bytes[84 + 12], &nan, 4);
  refused(file("nan.stl", bytes), "point 1 has a coordinate that is no number");
  bytes = msh(whole);
  refused(file("short.msh", bytes.substr(0, bytes.size() - 4)), "expected 284 for the counts");
  bytes[bytes.size() - 4] = 8;
  refused(file("corner.msh", bytes), "triangle 12 has the corner 8, expected less than 8");
  refused(file("empty.stl", ""), "is no STL");
  refused(file("text.stl", "solid\nfacet\nvertex 0 0 0\nendfacet\n"),
          "text.stl:4: a facet has 1 corners, expected 3");
  refused(file("word.stl", "solid\nfacet\nvertex 0 0 x\n"),
          "word.stl:3: has 'x', expected a finite");
  refused(file("kind.stl", "solid\nfacets\n"),
          "kind.stl:2: has 'facets', expected facets of an STL");
  refused(file("nan.obj", "v 0 0 nan\n"), "nan.obj:1: has 'nan', expected a finite coordinate");
  refused(file("corner.obj", "v 0 0 0\nf 1 1 2\n"),
          "corner.obj:2: a face has the corner '2', expected a point from 1 to 1");
  refused(file("few.obj", "v 0 0 0\nf 1 1\n"), "few.obj:2: a face has 2 corners");
  refused(file("curve.obj", "v 0 0 0\nsurf 0 1 0 1 1\n"), "curve.obj:2: has a line of kind 'surf'");
  refused(file("none.obj", "v 0 0 0\n"), "which has no triangles, expected a surface");
  refused(file("far.obj", "v 1e200 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n"), "beyond 1e60");
  refused(file("mesh.dae", "<x/>"),
          "is COLLADA, whose scenes of cameras, lights and units are not read; expected .stl");
  refused("<mesh name='m' file='gone.stl'/>", "<mesh> file is 'gone.stl', which does not exist");
  write("../" + folder.filename().string() + "_beside.stl", stl(whole));
  const std::string beside = "../" + folder.filename().string() + "_beside.stl";
  refused("<mesh name='m' file='" + beside + "'/>", "which is not in the folder");
  std::filesystem::create_symlink(folder / beside, folder / "link.stl");
  refused("<mesh name='m' file='link.stl'/>", "which is not in the folder");
  std::filesystem::remove(folder / beside);
  refused("<mesh name='m' file='a.stl'/>", "expected a folder that is named from that of the model",
          "meshdir='/tmp'");
  refused("<mesh name='m' vertex='0 0 0 1'/>", "vertex has 4 numbers, expected 3 for each");
  refused("<mesh name='m' vertex='0 0 0' face='0 0 1'/>",
          "face has 1, expected a point from 0 to 1");
  refused("<mesh name='m'/>", "has no file and no vertex");
  refused("<mesh name='m' builtin='sphere'/>", "builtin is not read");
  refused("<mesh name='n' file='a.stl'/>", ": body 'b': <geom> mesh is 'm', expected the name");
  refused("<mesh name='m' file='a.stl'/><mesh name='m' file='b.stl'/>", "each name once among");
  std::filesystem::resize_file(write("big.stl", "solid"), std::uintmax_t{70} << 20);
  refused("<mesh name='m' file='big.stl'/>", "the file is over 64 MiB, expected a mesh");
  expect_refused(
      "<asset><mesh name='m' file='a.stl'/></asset><worldbody><body name='b'><joint/>\n"
      "<geom type='box' mesh='m'/></body></worldbody>",
      "m.xml", ":2: body 'b': <geom> type is box with a mesh to fit");
  expect_refused(
      "<worldbody><body name='b'><joint/>\n<geom type='ellipsoid' size='1 1 1' "
      "shellinertia='true'/></body></worldbody>",
      "m.xml", ":2: body 'b': <geom> shellinertia is true for an ellipsoid");
}

// What weighs nothing, or rests, is not read: its file need not be there.
TEST_F(MjcfMeshes, MeshesForTheEyeNeedNoFile) {
  const Scene scene = mjcf(
      "<asset><mesh name='m' file='gone.stl'/></asset><worldbody><geom type='mesh' mesh='m'/><body>"
      "<joint/><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/><geom type='mesh' mesh='m'/>"
      "</body><body><joint/><geom size='1'/><geom type='mesh' mesh='m' "
      "mass='0'/></body><body><geom "
      "type='mesh' mesh='m'/></body></worldbody>");
  EXPECT_EQ(scene.bodies.size(), 3U);
}

}  // namespace
}  // namespace momenta::core_mjcf_meshes
