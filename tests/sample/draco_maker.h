#pragma once

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>

#include "gltf_maker.h"

namespace alcove::sample {

// A square of two triangles by KHR_draco_mesh_compression, with normals. The accessors have no data
// of their own. `method` is a method of Draco.
inline GltfMaker draco_square(int method) {
  const float at[2][3][3] = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
  const float normal[3] = {0, 0, 1};
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int position =
      builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int normals = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
  for (uint32_t f = 0; f < 2; ++f) {
    builder.SetAttributeValuesForFace(position, draco::FaceIndex(f), at[f][0], at[f][1], at[f][2]);
    builder.SetAttributeValuesForFace(normals, draco::FaceIndex(f), normal, normal, normal);
  }
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 11);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 8);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  GltfMaker maker;
  const int view = maker.view(std::vector<uint8_t>(buffer.data(), buffer.data() + buffer.size()));
  for (const char* type : {"VEC3", "VEC3", "SCALAR"}) {
    maker.json["accessors"].push_back({{"componentType", *type == 'V' ? 5126 : 5123},
                                       {"count", *type == 'V' ? 4 : 6},
                                       {"type", type}});
  }
  maker.json["meshes"] = {
      {{"primitives",
        {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}},
          {"indices", 2},
          {"extensions",
           {{"KHR_draco_mesh_compression",
             {{"bufferView", view}, {"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}}}}}}}}}};
  maker.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return maker;
}

}  // namespace alcove::sample
