"""The compiler: how kernels are compiled, kept and called."""
