// Uses libsdformat to read an SDF file with one model, and prints it as JSON for scripts/models-test: each link's mass,
// meshes and pose in the model, and whether its inertia is valid; each joint's links, type, pose, axis and range. Exits
// with 1 if the file is invalid.
#include <iostream>
#include <sdf/sdf.hh>

static void printPose(const ignition::math::Pose3d &pose)
{
  const ignition::math::Matrix4d matrix(pose);
  std::cout << "[";
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      std::cout << (i + j ? ", " : "") << matrix(i, j);
  std::cout << "]";
}

static const char *jointTypeName(sdf::JointType type)
{
  switch (type)
  {
    case sdf::JointType::REVOLUTE: return "revolute";
    case sdf::JointType::PRISMATIC: return "prismatic";
    case sdf::JointType::BALL: return "ball";
    default: return "other";
  }
}

int main(int, char **argv)
{
  sdf::Root root;
  auto errors = root.Load(argv[1]);
  ignition::math::Pose3d pose;
  if (errors.empty() && root.Model())
  {
    const auto &model = *root.Model();
    std::cout.precision(17);
    std::cout << "{\"links\": {";
    for (uint64_t i = 0; i < model.LinkCount(); ++i)
    {
      const auto &link = *model.LinkByIndex(i);
      for (const auto &error : link.SemanticPose().Resolve(pose, "__model__")) errors.push_back(error);
      std::cout << (i ? ", " : "") << "\"" << link.Name() << "\": {\"mass\": " << link.Inertial().MassMatrix().Mass()
                << ", \"valid\": " << link.Inertial().MassMatrix().IsValid() << ", \"meshes\": [";
      for (uint64_t j = 0; j < link.VisualCount(); ++j)
        std::cout << (j ? ", " : "") << "\"" << link.VisualByIndex(j)->Geom()->MeshShape()->Uri() << "\"";
      std::cout << "], \"pose\": ";
      printPose(pose);
      std::cout << "}";
    }
    std::cout << "}, \"joints\": {";
    for (uint64_t i = 0; i < model.JointCount(); ++i)
    {
      const auto &joint = *model.JointByIndex(i);
      for (const auto &error : joint.SemanticPose().Resolve(pose, "__model__")) errors.push_back(error);
      std::cout << (i ? ", " : "") << "\"" << joint.Name() << "\": {\"parent\": \"" << joint.ParentLinkName()
                << "\", \"child\": \"" << joint.ChildLinkName() << "\", \"type\": \"" << jointTypeName(joint.Type())
                << "\", \"pose\": ";
      printPose(pose);
      if (const auto *axis = joint.Axis())
      {
        const auto xyz = axis->Xyz();
        std::cout << ", \"axis\": [" << xyz.X() << ", " << xyz.Y() << ", " << xyz.Z() << "]";
        // Without limits in the file, libsdformat returns -1e16 and 1e16.
        if (axis->Lower() > -1e15 && axis->Upper() < 1e15)
          std::cout << ", \"range\": [" << axis->Lower() << ", " << axis->Upper() << "]";
      }
      std::cout << "}";
    }
    std::cout << "}}" << std::endl;
  }
  for (const auto &error : errors) std::cerr << error.Message() << std::endl;
  return errors.empty() && root.Model() ? 0 : 1;
}
