"""Particle arrays on a device, their neighbour lists, and launches that use every core."""
