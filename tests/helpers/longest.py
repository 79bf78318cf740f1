"""Which test files take longest: they are begun first, lest one worker be left with one of them at the end."""

LONGEST = (
    "test_make.py",
    "test_docs.py",
    "test_readme.py",
    "test_from_scratch.py",
    "test_layer_body.py",
    "test_tighter.py",
    "test_finite_strain_scene.py",
    "test_compare_bodies.py",
    "test_crosscheck.py",
    "test_jobs.py",
    "test_states.py",
    "test_finite_sphere_command.py",
    "test_finite_sphere_study.py",
    "test_halfspace_trace.py",
    "test_further_folds.py",
    "test_layers.py",
    "test_weak_form.py",
)
