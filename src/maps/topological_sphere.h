// Meshes that a sphere can be bent into.
#pragma once

#include "maps/mesh_names.h"
#include "spherical_springs/maps/triangle_mesh.h"

namespace spherical_springs::mesh {

/// Faces of no area pass, as long as their vertices are three.
/// @throw std::invalid_argument, which names the first face, edge or vertex at fault in the words
/// of `names`, unless vertices are finite and all in use, there are four faces or more, and the
/// mesh is closed, manifold, oriented the same way throughout, of one piece and of genus 0.
void requireTopologicalSphere(const TriangleMesh& mesh, const MeshNames& names = {});

}  // namespace spherical_springs::mesh
