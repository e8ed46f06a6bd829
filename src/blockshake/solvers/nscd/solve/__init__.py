"""The local problem and the nonlinear block Gauss-Seidel iteration (NLGS)."""
