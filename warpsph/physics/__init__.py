"""Physical models: what each needs, its limits on the time step, and its launches."""
