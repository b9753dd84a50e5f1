# Runs in the guest as root, in /host: sources the checks one after another, closes with the counts.
source checks/lib.sh
for file in checks/[0-9]*.sh; do
  started=$SECONDS
  source "$file"
  echo "        $(basename "$file" .sh): $((SECONDS - started)) s"
done
echo "guest: $passed passed, $failed failed"
[ $failed = 0 ]
