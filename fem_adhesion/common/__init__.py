"""What studies share, each once.

Numbers: `units`, `numbers`, `facts`. Pages and pictures: `page_tables`, `style`. Files: `files`, `writing`. The
terminal: `terminal`, `options`, `scene_options`. Contacts in SI: `contact`. Long work: `jobs`, `store`, `code_digest`,
`machine`.
"""
