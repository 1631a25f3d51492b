#version 450
// Texture times light, with the holes of the texture. Both are gamma-encoded, so the product is what a gamma-correct renderer would show.
// Then fog by distance. SAPIEN has no uniform for it: the scene's ambient light, which nothing else uses here,
// carries the extinction per metre (red) and the fog's own light (green), see simulator/disturbances/fog.py.

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

layout(set = 2, binding = 0) uniform MaterialBuffer {
  vec4 emission;
  vec4 baseColor;
  float fresnel;
  float roughness;
  float metallic;
  float transmission;
  float ior;
  float transmissionRoughness;
  int textureMask;
  int padding1;
  vec4 textureTransforms[6];
} materialBuffer;

layout(set = 2, binding = 1) uniform sampler2D colorTexture;
layout(set = 2, binding = 2) uniform sampler2D roughnessTexture;
layout(set = 2, binding = 3) uniform sampler2D normalTexture;
layout(set = 2, binding = 4) uniform sampler2D metallicTexture;
layout(set = 2, binding = 5) uniform sampler2D emissionTexture;

// All but ambientLight unused, but SAPIEN looks these blocks up by name.
struct PointLight {
  vec4 position;
  vec4 emission;
};

struct DirectionalLight {
  vec4 direction;
  vec4 emission;
};

struct SpotLight {
  vec4 position;
  vec4 direction;
  vec4 emission;
};

layout(set = 3, binding = 0) uniform SceneBuffer {
  vec4 ambientLight;
  DirectionalLight directionalLights[3];
  SpotLight spotLights[10];
  PointLight pointLights[10];
  SpotLight texturedLights[1];
} sceneBuffer;

layout(location = 0) in vec2 inUV;
layout(location = 1) in vec3 inLight;
layout(location = 2) in vec3 inView;

layout(location = 0) out vec4 outColor;

void main() {
  vec4 texel = texture(colorTexture, inUV);
  if (texel.a < 0.5) discard;
  vec3 colour = texel.rgb * inLight;
  if (sceneBuffer.ambientLight.r > 0.0) {
    float clear = exp(-sceneBuffer.ambientLight.r * length(inView));
    colour = mix(vec3(sceneBuffer.ambientLight.g), min(colour, vec3(1)), clear);
  }
  outColor = vec4(colour, 1);
}
