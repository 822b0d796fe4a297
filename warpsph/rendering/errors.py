"""What can be wrong with a request for pictures."""


class RenderError(ValueError):
    """Pictures that cannot be made from what was given; the text says why and what would do."""
