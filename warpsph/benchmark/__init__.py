"""How fast the solver steps, measured against yardsticks of the same machine in the same minutes."""
