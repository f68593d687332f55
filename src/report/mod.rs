//! Error against run time, as tables, plots and pages.
