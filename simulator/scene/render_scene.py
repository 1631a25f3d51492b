"""What the camera sees: the world as a few large meshes in SAPIEN, and six cameras that make a panorama."""

import math
import os
from pathlib import Path

import cv2
import numpy as np
import numpy.typing as npt
import sapien
from sapien import render

from simulator.robot.articulation import flat_pose
from simulator.scene.disk_cache import DiskCache
from simulator.scene.mesh_shapes import mesh_of
from simulator.scene.meshes import Mesh
from simulator.scene.painter import Look, Painter, look_of
from simulator.scene.parts import Contents, Light, Material, Part, Pose2
from simulator.scene.sky import RADIUS_M, backdrop, sunlight
from simulator.scene.static_scene import by_material, lit_meshes
from simulator.sensors.attitude import UPRIGHT, Quaternion
from simulator.sensors.panorama import BORDER_PX, CubeToEquirect, Image, face_fov_rad, face_rotations
from simulator.settings import CameraSettings
from simulator.world.world_file import WorldFile

SHADERS = Path(__file__).parent / "shaders" / "baked"
AWAY = sapien.Pose([0.0, 0.0, -500.0])


def set_up_renderer() -> None:
    """Choose our one-pass shader and byte pictures; must come before the first camera of the process."""
    render.set_log_level("error")
    render.set_global_config(max_num_materials=512, max_num_textures=512)
    render.set_camera_shader_dir(os.fspath(SHADERS))
    render.set_picture_format("Color", "r8g8b8a8unorm")


class RenderScene:
    """The rendered world. Light is computed on construction (a few seconds) unless the cache has it."""

    def __init__(
        self,
        world: WorldFile,
        contents: Contents,
        camera: CameraSettings,
        painter: Painter,
        cache: DiskCache,
        sky_brightness: float = 1.0,
    ) -> None:
        """Build meshes, textures, light and cameras.

        Args:
            world: the world file.
            contents: its parts and lights, see world.contents.expand.
            camera: picture size and place of the camera.
            painter: draws textures, for this and for every body added later.
            cache: keeps meshes and their light.
            sky_brightness: factor for what lies beyond the world.
        """
        set_up_renderer()
        self._settings = camera
        self._painter = painter
        self._scene = sapien.Scene([render.RenderSystem()])
        self._looks: dict[Look, render.RenderMaterial] = {}
        self._beyond, self._sky_brightness = backdrop(world), sky_brightness
        self._static = self._add_static(world, *contents, cache)
        self._mount, self._cameras = self._add_cameras()
        self._warp = CubeToEquirect(camera.width_px, self._cameras[0].width)
        self._faces = np.empty((6 * self._cameras[0].width, self._cameras[0].width, 4), np.uint8)

    def change_static(
        self,
        world: WorldFile,
        contents: Contents,
        painter: Painter,
        cache: DiskCache,
        sky_brightness: float,
    ) -> None:
        """Show another state of the world; its light is computed anew unless the cache has it."""
        self._painter, self._sky_brightness = painter, sky_brightness
        self._scene.remove_entity(self._static)
        self._static = self._add_static(world, *contents, cache)

    def set_fog(self, extinction: float, grey: float) -> None:
        """Fog for all pictures from now on: extinction per metre (0 is none) and its own light, 0 to 1."""
        # The shader reads both from the ambient light, which nothing else uses.
        self._scene.set_ambient_light([extinction, grey, 0.0])

    def add_body(self, parts: tuple[Part, ...], brightness: float = 1.0) -> sapien.Entity:
        """Add something that moves: parts in the body's frame, lit evenly from above."""
        entity = sapien.Entity()
        body = render.RenderBodyComponent()
        for material, mesh in by_material(parts).items():
            shade = (0.62 + 0.3 * mesh.normals[:, 2:] + 0.08 * mesh.normals[:, :1]) * np.array(
                [[1.0, 0.98, 0.95]]
            )
            shade = shade if brightness == 1.0 else shade * brightness
            body.attach(self._shape(mesh, shade.astype(np.float32), material))
        entity.add_component(body)
        self._scene.add_entity(entity)
        return entity

    def remove_body(self, entity: sapien.Entity) -> None:
        """Take something that moves out of the scene for good."""
        self._scene.remove_entity(entity)

    def move(self, entity: sapien.Entity, pose: sapien.Pose | None) -> None:
        """Put a body at a pose, or out of sight."""
        entity.set_pose(pose if pose is not None else AWAY)

    def move_flat(self, entity: sapien.Entity, pose: Pose2 | None) -> None:
        """Put a body on the floor at (x, y, yaw), or out of sight."""
        self.move(entity, None if pose is None else flat_pose(*pose))

    def panorama(self, pose: Pose2, lean: Quaternion = UPRIGHT) -> Image:
        """Picture from a pose (x, y, yaw); (width / 2, width, 3) BGR bytes.

        Args:
            pose: position on the floor and heading.
            lean: of the camera about its centre, see `simulator.sensors.attitude`.
        """
        self._expose(pose, lean)
        size = self._cameras[0].width
        for k, camera in enumerate(self._cameras):
            self._faces[k * size : (k + 1) * size] = camera.get_picture("Color")
        return np.asarray(cv2.cvtColor(self._warp(self._faces), cv2.COLOR_RGBA2BGR), np.uint8)

    def measured_panorama(
        self, pose: Pose2, lean: Quaternion = UPRIGHT
    ) -> tuple[Image, npt.NDArray[np.float32]]:
        """The same picture and ranges of its pixels, (width / 2, width) metres, inf for nothing."""
        picture = self.panorama(pose, lean)
        near, far = self._cameras[0].near, self._cameras[0].far
        shares = np.concatenate([camera.get_picture("GbufferDepth") for camera in self._cameras])
        # What Vulkan's projection writes into the depth buffer is even in 1 / depth, 0 at near and 1 at far.
        depths = np.where(shares < 1.0, near * far / (far - shares * (far - near)), np.inf)
        return picture, self._warp.ranges(depths.astype(np.float32))

    def _expose(self, pose: Pose2, lean: Quaternion) -> None:
        upright = flat_pose(*pose, z_m=self._settings.height_m)
        leans = lean != UPRIGHT
        self._mount.set_pose(upright * sapien.Pose([0.0, 0.0, 0.0], list(lean)) if leans else upright)
        self._scene.update_render()
        for camera in self._cameras:
            camera.take_picture()

    def _add_static(
        self, world: WorldFile, parts: tuple[Part, ...], lights: tuple[Light, ...], cache: DiskCache
    ) -> sapien.Entity:
        self._painter.order(part.material for part in parts)  # drawn while the light is computed
        entity = sapien.Entity()
        body = render.RenderBodyComponent()
        viewpoints = _viewpoints(world, self._settings.height_m)
        for lit in lit_meshes(parts, lights, world.lighting, viewpoints, cache, sunlight(world), world.alike):
            glow = lit.material.glow
            shade = np.full_like(lit.light, glow) if glow else lit.light
            body.attach(self._shape(lit.mesh, shade, lit.material))
        for part in self._beyond:
            mesh = mesh_of(part)
            glow = part.material.glow * self._sky_brightness
            body.attach(self._shape(mesh, np.full_like(mesh.vertices, glow), part.material))
        entity.add_component(body)
        self._scene.add_entity(entity)
        return entity

    def _shape(
        self, mesh: Mesh, shade: npt.NDArray[np.float32], material: Material
    ) -> render.RenderShapeTriangleMesh:
        return render.RenderShapeTriangleMesh(
            mesh.vertices, mesh.triangles, shade, mesh.uvs, self._material(material)
        )

    def _material(self, material: Material) -> render.RenderMaterial:
        look = look_of(material)
        if look not in self._looks:
            pixels = self._painter.take(material)
            rgba = pixels if pixels.shape[2] == 4 else cv2.cvtColor(pixels, cv2.COLOR_RGB2RGBA)
            levels = int(math.log2(min(rgba.shape[:2]))) + 1
            made = render.RenderMaterial()
            made.base_color_texture = render.RenderTexture2D(rgba, "R8G8B8A8Unorm", mipmap_levels=levels)
            self._looks[look] = made
        return self._looks[look]

    def _add_cameras(self) -> tuple[sapien.Entity, list[render.RenderCameraComponent]]:
        mount = sapien.Entity()
        size = 2 * round(self._settings.width_px * self._settings.face_scale / 2) + 2 * BORDER_PX
        cameras = []
        for rotation in face_rotations():
            camera = render.RenderCameraComponent(size, size)
            camera.set_fovy(face_fov_rad(size), compute_x=True)
            camera.near = self._settings.near_m
            camera.far = 2.0 * RADIUS_M if self._beyond else self._settings.far_m
            matrix = np.eye(4)
            matrix[:3, :3] = rotation
            mount.add_component(camera)
            camera.local_pose = sapien.Pose(matrix)
            cameras.append(camera)
        self._scene.add_entity(mount)
        return mount, cameras


def _viewpoints(world: WorldFile, height_m: float) -> npt.NDArray[np.float32]:
    """Corners of all rooms and openings at camera height, (k, 3): the camera is always between them."""
    return np.array([(x, y, height_m) for rx, ry in world.rectangles() for x in rx for y in ry], np.float32)
