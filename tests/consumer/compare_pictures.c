/* Compares two grey pictures of one size: compare_pictures A.pgm B.pgm LARGEST. Ends with 1 if a
 * pixel differs by more than LARGEST, and prints how many differ, and by how much. */
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char** argv) {
  FILE* a = argc == 4 ? fopen(argv[1], "rb") : NULL;
  FILE* b = argc == 4 ? fopen(argv[2], "rb") : NULL;
  if (a == NULL || b == NULL) {
    fprintf(stderr, "The pictures cannot be read.\n");
    return 1;
  }
  int largest = 0, different = 0, pixels = 0, of_a, of_b;
  do {
    of_a = getc(a);
    of_b = getc(b);
    const int by = abs(of_a - of_b);
    largest = by > largest ? by : largest;
    different += by > 0;
    pixels += of_a != EOF;
  } while (of_a != EOF && of_b != EOF);
  fclose(a);
  fclose(b);
  printf("%d of %d bytes differ, by at most %d.\n", different, pixels, largest);
  return of_a == of_b && pixels > 1000 && largest <= atoi(argv[3]) ? 0 : 1;
}
