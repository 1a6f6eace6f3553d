# trajectory.csv in R: columns by their label; empty cells become NA.
table <- read.csv(commandArgs(trailingOnly = TRUE)[1], check.names = FALSE)
t <- table[["t [s]"]]
energy <- table[["energy [J]"]]
cat(sprintf("%d samples to %g s, largest change of energy %.3g J\n", length(t), tail(t, 1), max(abs(energy - energy[1]))))
