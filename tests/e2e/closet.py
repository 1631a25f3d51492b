"""A world that is explored in no time: one small room."""

CLOSET = """
format: topnav-world/1
name: closet
start: {x_m: 0.8, y_m: 0.8, yaw_deg: 0}
rooms:
  - name: closet
    x_m: [0.0, 3.0]
    y_m: [0.0, 2.4]
    floor: {texture: boards, colour: [176, 132, 92], seed: 1}
    walls: {texture: plaster, colour: [232, 224, 208], seed: 2}
    ceiling: {texture: ceiling, colour: [242, 240, 234], seed: 3}
furniture:
  - {kind: bookshelf, at_m: [1.5, 0.0], yaw_deg: 90, seed: 4, options: {width_m: 1.2}}
  - {kind: picture, at_m: [0.0, 1.2], z_m: 1.6, seed: 5, options: {style: landscape}}
  - {kind: picture, at_m: [3.0, 1.2], z_m: 1.6, yaw_deg: 180, seed: 6, options: {style: street}}
  - {kind: picture, at_m: [1.5, 2.4], z_m: 1.5, yaw_deg: -90, seed: 7, options: {style: poster}}
  - {kind: ceiling_light, at_m: [1.5, 1.2], z_m: 2.6}
"""
