//! Shown: draws stored records.
