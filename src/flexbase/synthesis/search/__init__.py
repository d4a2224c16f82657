"""How methods look for a sampled controller: shaping, servos, descents, trials."""
