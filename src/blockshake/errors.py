"""The one error that a user can mend, worded in one line."""


class InputError(ValueError):
    """Bad input: names the file, the key and what was expected.

    Parameters
    ----------
    where : str
        File or command-line option at fault.
    key : str
        Dotted key inside it; empty when the whole file is at fault.
    expected : str
        A correct input in words, and the value found where that helps.
    """

    def __init__(self, where, key, expected):
        self.where, self.key, self.expected = str(where), str(key), str(expected)
        place = f"{self.where}: {self.key}" if self.key else self.where
        super().__init__(f"{place}: {self.expected}")
