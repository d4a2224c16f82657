"""The joints in which an arm stands best on a target."""
