"""Do the two solvers agree? Four levels of comparison, their record and table, and the command `compare`."""
