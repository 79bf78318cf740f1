"""What studies share, each once.

Numbers with units and errors, and sentences made of them: `numbers`. Pages and pictures: `page`, `style`, and `lines`,
curves to be drawn. Files: `files`, `facts` (what records say besides, the code's digest). The terminal: `options`,
`scene_options`, `terminal`. Contacts in SI: `contact`. The atlas's events: `known`. Long work: `jobs`.
"""
