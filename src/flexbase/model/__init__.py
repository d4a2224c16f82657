"""What a project file says, as frozen arrays."""
