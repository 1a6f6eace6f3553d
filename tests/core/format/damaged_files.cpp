// Damaged bytes of meshes and of robots' files, cut short or with bits turned over: each gives a
// mesh or a scene, or one sentence; and what is too large is refused before it is read.

#include "equations/refusal.h"
#include "equations/scene_folder.h"

#include <momenta/core/format/mesh/mesh_mass.h>
#include <momenta/core/scene/validate.h>

#include <chrono>
#include <cstring>
#include <functional>

namespace momenta::core_damaged_files {
namespace {

using reading::Mesh;

/// A tetrahedron in each format.
std::string stl() {
  std::string bytes(80, 'x');
  const std::uint32_t count = 4;
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  const float points[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int corners[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  for (const auto& t : corners) {
    bytes.append(12, '\0');
    for (const int c : t) bytes.append(reinterpret_cast<const char*>(points[c]), 12);
    bytes.append(2, '\0');
  }
  return bytes;
}
std::string stl_text() {
  return "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 "
         "0\nendloop\n"
         "endfacet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1e-1\n"
         "endloop\nendfacet\nendsolid t\n";
}
std::string obj() {
  return "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1/1 2/2 4/3\nf -4 -1 -2\nf 2//1 3//1 "
         "4//1\n";
}
std::string msh() {
  std::string bytes;
  for (const std::uint32_t n : {4U, 0U, 0U, 4U}) bytes.append(reinterpret_cast<const char*>(&n), 4);
  const float points[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  bytes.append(reinterpret_cast<const char*>(points), sizeof points);
  const std::uint32_t corners[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  bytes.append(reinterpret_cast<const char*>(corners), sizeof corners);
  return bytes;
}

/// Every truncation, and `flips` texts with one to four bits turned over.
void each_damage(const std::string& whole, int flips,
                 const std::function<void(const std::string&)>& f) {
  for (std::size_t i = 0; i < whole.size(); ++i) f(whole.substr(0, i));
  std::mt19937 random(1);
  for (int i = 0; i < flips; ++i) {
    std::string bytes = whole;
    for (unsigned k = 0; k <= random() % 4; ++k)
      bytes[random() % bytes.size()] ^= static_cast<char>(1U << (random() % 8));
    f(bytes);
  }
}

using Parse = Mesh (*)(std::string_view, const std::string&);

TEST(DamagedMeshes, AreMeshesOrSentences) {
  const std::tuple<const char*, std::string, Parse> formats[] = {
      {"stl", stl(), reading::parse_stl},
      {"stl text", stl_text(), reading::parse_stl},
      {"obj", obj(), reading::parse_obj},
      {"msh", msh(), reading::parse_msh}};
  for (const auto& [name, whole, parse] : formats) {
    std::string fault;
    EXPECT_GT(reading::mass_of_shell(parse(whole, "m"), fault).measure, 0) << name;
    EXPECT_EQ(fault, "");
    int meshes = 0, sentences = 0;
    each_damage(whole, 4000, [&, read = parse, what = name](const std::string& bytes) {
      try {
        const Mesh mesh = read(bytes, "m");
        ++meshes;
        for (const auto& p : mesh.points) ASSERT_TRUE(p.allFinite());
        for (const auto& t : mesh.triangles)
          for (const std::uint32_t corner : t) ASSERT_LT(corner, mesh.points.size());
        // Weighing it ends too: with a mass, or with a reason.
        for (const auto weigh :
             {reading::mass_of_inside, reading::mass_by_pyramids, reading::mass_of_shell}) {
          std::string why;
          const reading::MeshMass mass = weigh(mesh, why);
          EXPECT_TRUE(!why.empty() || mass.measure > 0 || !std::isfinite(mass.measure)) << what;
        }
      } catch (const SceneError& error) {
        ++sentences;
        const std::string sentence = error.what();
        EXPECT_TRUE(sentence.starts_with("m:")) << sentence;
        EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
      }
    });
    EXPECT_GT(meshes, 50) << name;
    EXPECT_GT(sentences, 50) << name;
  }
}

class DamagedModels : public equations::SceneFolder {};

TEST_F(DamagedModels, AreScenesOrSentences) {
  write("leg.sdf",
        "<sdf version='1.9'><model name='leg'><pose>1 0 0 0 0 0</pose><link name='l'><inertial>"
        "<mass>1</mass></inertial></link></model></sdf>");
  write("m.stl", stl());
  const std::string sdf =
      "<sdf version='1.9'><world name='w'><gravity>0 0 -1</gravity><model name='m'><link name='a'>"
      "<pose>0 0 1 0 0 0.5</pose><inertial><mass>2</mass></inertial><visual name='v'><geometry>"
      "<mesh><uri>m.stl</uri></mesh></geometry></visual></link><joint name='j' type='universal'>"
      "<parent>world</parent><child>a</child><axis><xyz>1 0 0</xyz><limit><lower>-1</lower><upper>1"
      "</upper></limit><dynamics><damping>1</damping></dynamics></axis><axis2><xyz>0 1 0</xyz>"
      "</axis2></joint></model><include><uri>leg.sdf</uri><name>n</name></include></world></sdf>";
  const std::string urdf =
      "<robot name='r'><link name='b'/><link name='a'><inertial><mass value='1'/><inertia ixx='1' "
      "iyy='1' izz='1'/></inertial><visual><geometry><mesh filename='m.stl' scale='1 1 2'/>"
      "</geometry></visual></link><joint name='j' type='revolute'><origin xyz='1 0 0' rpy='0 0 1'/>"
      "<parent link='b'/><child link='a'/><limit lower='-1' upper='1'/><dynamics damping='1' "
      "friction='.1'/></joint></robot>";
  const std::string mjcf =
      "<mujoco><compiler angle='radian'/><asset><mesh name='t' file='m.stl' "
      "inertia='exact'/></asset>"
      "<worldbody><body name='a' euler='0 0 1'><joint name='h' range='-1 1' armature='.1'/><geom "
      "type='mesh' mesh='t'/><body><joint type='ball' stiffness='1'/><geom size='1'/></body></body>"
      "</worldbody><equality><joint joint1='h' polycoef='0 1'/></equality><keyframe><key name='k' "
      "qpos='1 1 0 0 0'/></keyframe></mujoco>";
  ReadOptions options;
  for (const auto& [name, whole] : {std::pair{"d.sdf", sdf}, {"d.urdf", urdf}, {"d.xml", mjcf}}) {
    options.key = name == std::string("d.xml") ? "k" : "";
    EXPECT_FALSE(read(name, whole, options).bodies.empty());
    int scenes = 0, sentences = 0;
    const auto start = std::chrono::steady_clock::now();
    each_damage(whole, 1500, [&, file = std::string(name)](const std::string& bytes) {
      try {
        const Scene scene = read(file, bytes, options);
        validate(scene);
        ++scenes;
      } catch (const SceneError& error) {
        ++sentences;
        const std::string sentence = error.what();
        EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
        EXPECT_GT(sentence.size(), 10U);
      }
    });
    EXPECT_GT(scenes, 20) << name;
    EXPECT_GT(sentences, 100) << name;
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(120)) << name;
  }
}

// A gigabyte with the head of a mesh, and a head that asks for four thousand million triangles.
TEST_F(DamagedModels, TooLargeIsRefusedUnread) {
  const auto file = write("g.stl", stl());
  std::filesystem::resize_file(file, 1UL << 30U);  // a hole, which takes no room
  const auto start = std::chrono::steady_clock::now();
  const auto refused_mesh = [](const std::filesystem::path& path) {
    return equations::thrown<SceneError>([&] { static_cast<void>(reading::read_mesh(path)); });
  };
  EXPECT_NE(refused_mesh(file).find("64 MiB"), std::string::npos) << refused_mesh(file);
  std::string head = msh();
  head[12] = head[13] = head[14] = head[15] = '\x7f';
  EXPECT_NE(refused_mesh(write("h.msh", head)).find("expected"), std::string::npos);
  const auto text = write("g.sdf", "<sdf version='1.9'>");
  std::filesystem::resize_file(text, 1UL << 30U);
  EXPECT_THROW(read_scene(text), SceneError);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

}  // namespace
}  // namespace momenta::core_damaged_files
