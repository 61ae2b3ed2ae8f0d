// Models made of shapes, for the tests of contact.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "sinew/contact/surfaces.h"
#include "sinew/forces/assemble.h"
#include "sinew/mesh/shapes.h"

namespace sinew::testing {

inline TetMesh moved(TetMesh mesh, const Mat3& f, const Vec3& shift) {
  for (Vec3& x : mesh.nodes) x = f * x + shift;
  return mesh;
}

inline TetMesh moved(const TetMesh& mesh, const Vec3& shift) {
  return moved(mesh, Mat3::Identity(), shift);
}

inline Model surface_pair_model(const std::vector<TetMesh>& meshes,
                                const BodyContact& contact = {true, true}) {
  Model model;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    BodySpec spec;
    spec.name = "body" + std::to_string(i);
    spec.mesh = meshes[i];
    spec.materials = {Material{}};
    spec.regions = {"rest"};
    add_body(model, spec);
  }
  model.body_contact = contact;
  finish(model);
  build_contact_surface(model);
  return model;
}

inline std::vector<Contact> contacts_of(const Model& model, const std::vector<Vec3>& from,
                                        const std::vector<Vec3>& to, double reach = 0.0) {
  SurfaceContacts contacts(model);
  std::vector<Contact> found;
  contacts.find(from, to, reach, found);
  return found;
}

inline Mat3 random_rotation(std::mt19937& rng, double most = 3.14159265358979) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> angle(0.0, most);
  return Eigen::AngleAxisd(angle(rng), Vec3(normal(rng), normal(rng), normal(rng)).normalized())
      .toRotationMatrix();
}

}  // namespace sinew::testing
