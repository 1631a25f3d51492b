"""Where pictures come from: one file for each kind, named in `services.camera.kinds`."""
