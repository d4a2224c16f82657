"""The arm itself and its mode shapes, in the plane and in space."""
