"""The loop as hardware runs it: the paper's gain at 1 kHz with one sample of delay, and a controller made for that."""

import numpy as np

import flexbase as fb

plant = fb.load("ueda2003")
start, goal = plant.at_tip([0.33, 0.25]), plant.at_tip([0.33, -0.25])
printed = np.array([[0.12, 0.079], [0.079, -0.15]])
real = fb.Sensing(encoder_counts=2.0**18, task_noise=5e-6, torque_limit=(500.0, 500.0))
push = fb.Push((50.0, 0.0), start=0.45, duration=0.02)

papers = fb.make_controller(goal, loop=fb.Loop(fb.Gain(printed), sensing=real))
ours = fb.make_controller(goal, "coprime", fb.Loop(sensing=real))
for controller in (papers, ours):
    for engine in ("builtin", "mujoco"):
        move = fb.SampledMove(switch=0.15, end=0.8, engine=engine)
        run = fb.simulate_sampled(controller, start, push=push, move=move)
        print(run.summary(), end="\n\n")
