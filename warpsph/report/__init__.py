"""Reports of validations: error against cost, curves over references, conservation, in words and pictures."""
