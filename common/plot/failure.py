"""What is said where something cannot be done."""


class Failure(Exception):
    """One sentence that says what, where, and what would help."""
