"""The words of the field that commands print, explained in one file, which the documentation shows, too."""
