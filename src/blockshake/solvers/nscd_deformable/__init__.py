"""Nonsmooth contact dynamics of elastic and viscoelastic boxes."""
