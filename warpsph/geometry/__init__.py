"""Surfaces and outlines as plain numbers: read from files, made from formulas, checked, and asked for distances."""
