"""What studies share, each once.

Numbers with units and errors: `numbers`; sentences made of them: `words`. Pages and pictures: `page`, `style`. Files:
`files`, `facts` (what records say besides). The terminal: `options`, `scene_options`, `terminal`, `progress`. Contacts
in SI: `contact`. Long work: `jobs`, `store`, `code_digest`.
"""
