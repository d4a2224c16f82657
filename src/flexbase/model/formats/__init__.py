"""URDF and MJCF: validated first, read by Pinocchio and MuJoCo, turned into a chain of frozen arrays."""
