"""Device code of warpsph: Warp functions and kernels, free of any host logic.

A factory takes the options that select code (dimension, precision, model names) and returns the kernels
specialised for them. All numbers that may change between two runs of the same code travel in a constants
struct, so that a parameter study compiles once.
"""
