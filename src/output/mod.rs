//! What a run leaves behind: field series for ParaView, tables and the summary.
