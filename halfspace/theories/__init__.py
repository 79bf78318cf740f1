"""What theories say in closed form or by quadrature: Hertz, Bradley, JKR, DMT, Maugis, spheres, criteria of jumps."""
