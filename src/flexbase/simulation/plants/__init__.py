"""The nonlinear plants: built-in and MuJoCo behind one function."""
