#version 450
// One pass, no lights: the `normal` attribute of static meshes carries the light computed by simulator/scene/lighting.py.

layout(set = 0, binding = 0) uniform CameraBuffer {
  mat4 viewMatrix;
  mat4 projectionMatrix;
  mat4 viewMatrixInverse;
  mat4 projectionMatrixInverse;
  float width;
  float height;
} cameraBuffer;

layout(set = 1, binding = 0) uniform ObjectTransformBuffer {
  mat4 modelMatrix;
} objectTransformBuffer;

layout(set = 1, binding = 1) uniform ObjectDataBuffer {
  uvec4 segmentation;
  float transparency;
  int shadeFlat;
} objectDataBuffer;

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec3 tangent;
layout(location = 4) in vec3 bitangent;

layout(location = 0) out vec2 outUV;
layout(location = 1) out vec3 outLight;
layout(location = 2) out vec3 outView; // metres from the camera

void main() {
  outUV = uv;
  // SAPIEN turns normals that disagree with the winding; light is never negative.
  outLight = abs(normal);
  vec4 view = cameraBuffer.viewMatrix * (objectTransformBuffer.modelMatrix * vec4(position, 1));
  outView = view.xyz;
  gl_Position = cameraBuffer.projectionMatrix * view;
}
