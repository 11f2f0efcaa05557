//! Common interface of faults and cautions.

use std::error::Error;

use miette::Severity;

/// A fault or a caution.
pub trait Subject: Error + 'static {
    /// Severity.
    const SEVERITY: Severity;

    /// Returns what is allowed or what to do, unless the message contains it.
    fn advice(&self) -> Option<String>;

    /// Returns the label beside the marked text.
    fn label(&self) -> &'static str;
}
