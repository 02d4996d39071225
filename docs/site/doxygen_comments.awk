# Doxygen's input filter: the project's plain comments as documentation comments. The comment at the top of a header is about
# the file, one above a declaration about it, one behind a declaration about that.
NR == 1 && /^\/\// { print "/// \\file" }
/^ *\/\/( |$)/ {
  sub(/\/\//, "///")
  print
  next
}
/[;,{}] +\/\/ / && !/^ *\/\// { sub(/ +\/\/ /, "  ///< ") }
{ print }
