"""One small tree of exceptions, shared by every room."""


class ThermoscopeError(Exception):
    """Anything the tool refuses, in one message a user can act on."""


class InputError(ThermoscopeError):
    """An input is wrong: says what, where, and what would be right.

    Parameters
    ----------
    what : the fault, with the offending value
    where : file and key, column or part in which it stands
    right : what would be accepted instead
    """

    def __init__(self, what: str, where: str = "", right: str = "") -> None:
        self.what, self.where, self.right = what, where, right
        message = f"{where}: {what}" if where else what
        super().__init__(f"{message}; {right}" if right else message)


class MissingDependency(ThermoscopeError):  # noqa: N818
    """A program or system library is missing; the message carries the command that installs it."""


class NoSolution(ThermoscopeError):  # noqa: N818
    """A model has no temperatures at some values of its parameters: it runs away. The message says where and when."""
