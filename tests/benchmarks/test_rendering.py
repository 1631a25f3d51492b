"""Processor time of a panorama of the stack's size against SAPIEN's own way; says figures, gates nothing.

pytest -q -s tests/benchmarks/test_rendering.py

The reference is what SAPIEN's manual shows: its own shader, six faces of 256 x 256 read back as float and
turned into bytes. A second one does the same with our shader, which tells the shader's share from the rest.
"""

import time

import numpy as np
import pytest

from simulator.sensors.panorama import CubeToEquirect, face_fov_rad, face_rotations
from simulator.settings import CameraSettings, SimulationSettings
from simulator.world.world_file import load_world

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(600)]

WIDTH, FACE, ROUNDS = 1024, 256, 15
POSES = [(1.3, 1.3, 0.3), (4.0, 3.0, 1.9), (6.5, 4.5, -2.0)]


class FloatFaces:
    """Six cameras of a scene, read back as float."""

    def __init__(self, scene, shader):
        import sapien
        from sapien import render

        before = render.get_camera_shader_dir()
        render.set_camera_shader_dir(shader or before)
        render.set_picture_format("Color", "r32g32b32a32sfloat")
        self._scene, self._mount, self._cameras = scene, sapien.Entity(), []
        for rotation in face_rotations():
            camera = render.RenderCameraComponent(FACE, FACE)
            camera.set_fovy(face_fov_rad(FACE), compute_x=True)
            camera.near, camera.far = 0.015, 60.0
            self._mount.add_component(camera)
            matrix = np.eye(4)
            matrix[:3, :3] = rotation
            camera.local_pose = sapien.Pose(matrix)
            self._cameras.append(camera)
        scene.add_entity(self._mount)
        self._warp = CubeToEquirect(WIDTH, FACE)
        render.set_picture_format("Color", "r8g8b8a8unorm")
        render.set_camera_shader_dir(before)

    def panorama(self, *pose):
        from simulator.scene.render_scene import flat_pose

        self._mount.set_pose(flat_pose(*pose, z_m=CameraSettings().height_m))
        self._scene.update_render()
        for camera in self._cameras:
            camera.take_picture()
        faces = [camera.get_picture("Color")[..., 2::-1] for camera in self._cameras]
        return self._warp((np.clip(np.concatenate(faces), 0.0, 1.0) * 255.0).astype(np.uint8))


def test_panorama_against_six_float_faces(tmp_path, keep):
    from simulator.simulation import Simulation

    settings = SimulationSettings(camera=CameraSettings(width_px=WIDTH), cache_dir=tmp_path)
    simulation = Simulation(load_world("apartment"), settings)
    scene = simulation._view._scene._scene
    same_shader, stock = FloatFaces(scene, None), FloatFaces(scene, "default")
    ways = {
        "ours": simulation.panorama_at,
        "float, our shader": same_shader.panorama,
        "float, SAPIEN's shader": stock.panorama,
    }
    spent_ms = processor_ms(ways)
    figures = {name: round(float(np.median(times)), 2) for name, times in spent_ms.items()}
    ratios = {name: round(value / figures["ours"], 2) for name, value in figures.items()}
    pictures = [way(*POSES[0]).astype(int) for way in list(ways.values())[:2]]
    apart = float(np.abs(pictures[0] - pictures[1]).mean())
    told = {"processor_ms": figures, "times_ours": ratios, "mean_grey_levels_apart": round(apart, 2)}
    keep({"height_px": WIDTH // 2, "width_px": WIDTH, **told})
    assert apart < 4.0  # the same place, seen through fewer pixels
    assert all(value > 0.0 for value in figures.values())


def processor_ms(ways):
    """Processor time of each way, taken in turns: other work on the machine meets all alike."""
    spent = {name: [] for name in ways}
    for way in ways.values():
        way(*POSES[0])
    for number in range(ROUNDS):
        for name, way in ways.items():
            start_s = time.process_time()
            way(*POSES[number % len(POSES)])
            spent[name].append(1e3 * (time.process_time() - start_s))
    return spent
