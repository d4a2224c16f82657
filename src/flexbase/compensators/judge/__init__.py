"""What a gain does and what it may not do: certificates, laws, refusals."""
