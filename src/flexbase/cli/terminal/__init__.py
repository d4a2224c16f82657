"""What people see: tables, documents, files, progress, faults."""
