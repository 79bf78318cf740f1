"""What studies share, each once: numbers with errors, units, tables, records, style, files, jobs, options."""
