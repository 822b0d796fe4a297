"""Hard cases: scenes meant to break the scheme, each with figures and the bounds that they must keep."""
