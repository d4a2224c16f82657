"""Arms on flexible bases that all tests share: the paper's, closed-form ones, random ones, and independent oracles."""
