"""Pure spherical geometry: no I/O, no clock, numpy only.

Conventions, used by every module here and by every message that carries an angle
    camera frame   x forward, y left, z up (REP-103); the camera stands upright on the robot.
    longitude      radians in [-pi, pi): 0 straight ahead, grows to the left (counter-clockwise from above).
    latitude       radians in [-pi/2, pi/2]: positive above the horizon.
    bearing        unit vector b = (cos lat cos lon, cos lat sin lon, sin lat).
    pixel          (u, v), u right, v down, continuous: the pixel with indices (i, j) covers [i, i+1) x [j,
    j+1)
                   and its centre is (i + 0.5, j + 0.5). OpenCV key points and remap tables count from the
                   centre of the first pixel: add 0.5 to them before they enter this package.
    image          the centre column looks ahead; column 0 and the seam look backwards.
    yaw            rotation about z: a direction at longitude m in the target frame lies at m + yaw in the
    current.
"""
